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


cases = {f"streams/{p.parent.name}": json.loads(p.read_text(encoding="utf-8"))["expect"]
         for p in (HERE / "streams").glob("*/case.json")}
with_normals = {name for name, expect in cases.items() if "normals_sha256" in expect[0]}
with_options = {name for name, expect in cases.items() if len(expect) > 1 and expect[0]["points"] > 0}
assert len(with_normals) > 1 and len(with_options) > 2

assert failures("none") == set(), failures("none")
assert "streams/vector" in failures("last_value")
assert failures("no_normals") == with_normals, failures("no_normals")
assert all(c.startswith("refused/") for c in failures("never_refuses")) and len(failures("never_refuses")) > 20
assert len(failures("dies_on_error")) > 20
assert failures("ignores_levels") == with_options, failures("ignores_levels")
print("6 passed, 0 failed")
