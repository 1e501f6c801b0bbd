#!/usr/bin/env python3
"""The runner itself: decoders that are wrong in one way each must fail. test_run.py SLF"""
import json, pathlib, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
SLF = sys.argv[1]

WRAPPER = """#!/usr/bin/env python3
import pathlib, subprocess, sys
slf, fault, args = {slf!r}, {fault!r}, sys.argv[1:]
out = pathlib.Path(args[args.index("--dump") + 1])
done = subprocess.run([slf] + args)
if fault == "last_value" and done.returncode == 0:
    f = out / "components.npy"
    if f.exists():
        data = bytearray(f.read_bytes()); data[-1] ^= 1; f.write_bytes(data)
if fault == "no_normals" and (out / "octahedral.npy").exists(): (out / "octahedral.npy").unlink()
if fault == "never_refuses": sys.exit(0)
if fault == "dies_on_error" and done.returncode: import os; os.abort()
if fault == "ignores_levels": pass
sys.exit(done.returncode)
"""


def failures(fault, extra=()):
    with tempfile.TemporaryDirectory() as folder:
        wrapper = pathlib.Path(folder) / "decoder.py"
        wrapper.write_text(WRAPPER.format(slf=SLF, fault=fault))
        options = "" if fault == "ignores_levels" else " {options}"
        done = subprocess.run([sys.executable, str(HERE / "run.py"), "--json", "--decoder",
                               f"{sys.executable} {wrapper} decode {{in}} --dump {{out}}" + options, *extra],
                              capture_output=True, text=True)
        report = json.loads(done.stdout)
        assert (done.returncode == 0) == (report["failed"] == 0), fault
        return {c["case"] for c in report["cases"] if c["verdict"] == "failed"}


assert failures("none") == set(), failures("none")
assert "streams/vector" in failures("last_value")
assert failures("no_normals") == {"streams/normals"}, failures("no_normals")
assert all(c.startswith("refused/") for c in failures("never_refuses")) and len(failures("never_refuses")) > 20
assert len(failures("dies_on_error")) > 20
assert {"streams/vector", "streams/independent", "streams/normals"} == failures("ignores_levels")
print("6 passed, 0 failed")
