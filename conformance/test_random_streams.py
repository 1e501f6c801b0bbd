#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The check by random streams itself: decoders that do nothing, a little or too much must differ. test_random_streams.py SLF"""
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SLF = sys.argv[1]

# A decoder that is right but for one fault.
WRAPPER = """#!/usr/bin/env python3
import pathlib, subprocess, sys
import numpy as np
slf, fault, args = {slf!r}, {fault!r}, sys.argv[1:]
out = pathlib.Path(args[args.index("--dump") + 1])
if fault == "ignores the region": args = [word for word in args if not word.startswith("--region")]
if fault == "knows no region of two words": assert "--region" not in args
done = subprocess.run([slf] + args, capture_output=True)
def change(name, edit):
    file = out / (name + ".npy")
    if file.exists() and np.load(file).size: np.save(file, edit(np.load(file)))
if fault == "positions alone": (out / "components.npy").unlink(missing_ok=True)
if fault == "components alone": (out / "positions.npy").unlink(missing_ok=True)
if fault == "a point less": change("positions", lambda a: a[:-1])
if fault == "a point more": change("components", lambda a: np.concatenate([a, a[:1]]))
if fault == "the last value": change("components", lambda a: a + (np.arange(a.size) == a.size - 1).reshape(a.shape))
if fault == "other shape": change("positions", lambda a: a.ravel())
if fault == "normals too" and not (out / "octahedral.npy").exists() and not done.returncode:
    np.save(out / "octahedral.npy", np.ones((1, 2), np.uint16))
if fault == "no array" and not done.returncode: (out / "positions.npy").write_bytes(b"none")
if fault == "never refuses": sys.exit(0)
sys.exit(done.returncode)
"""
NONE = "knows no region of two words", "right"


def differing(command):
    """Exit code of the check, and how many of how many streams differ."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, HERE / "random_streams.py", "--decoder", command, "--seeds", "0", "3", "--keep", folder],
                              capture_output=True, text=True)
        tried, refused, differ = map(int, re.search(r"(\d+) decoded, (\d+) of them refused, (\d+) differ", done.stdout).groups())
        assert tried > refused > 0 and len(list(pathlib.Path(folder).iterdir())) == differ, done
        assert done.returncode == (differ > 0), done
        return tried, refused, differ


passed = 0
for program in ("true", "false"):
    tried, refused, differ = differing(program)
    assert differ == (tried if program == "true" else tried - refused), (program, tried, refused, differ)
    passed += 1
for fault in (*NONE, "ignores the region", "positions alone", "components alone", "a point less", "a point more", "the last value",
              "other shape", "normals too", "no array", "never refuses"):
    with tempfile.TemporaryDirectory() as folder:
        wrapper = pathlib.Path(folder) / "decoder.py"
        wrapper.write_text(WRAPPER.format(slf=SLF, fault=fault))
        tried, refused, differ = differing(f"{sys.executable} {wrapper} decode {{in}} --dump {{out}} {{options}}")
        assert (differ == 0) == (fault in NONE), (fault, tried, refused, differ)
        passed += 1
print(f"{passed} passed, 0 failed")
