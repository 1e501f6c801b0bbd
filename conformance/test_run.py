#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The runner itself: decoders that are wrong in one way each must fail, in the cases that show it. test_run.py SLF"""
import json, pathlib, subprocess, sys, tempfile
import xml.etree.ElementTree as xml

HERE = pathlib.Path(__file__).resolve().parent
SLF = sys.argv[1]

# A decoder that is right but for one fault, on the way in (options) or out (arrays, header, exit code).
WRAPPER = """#!/usr/bin/env python3
import json, os, pathlib, re, subprocess, sys, time
slf, fault, args = {slf!r}, {fault!r}, sys.argv[1:]
out = pathlib.Path(args[args.index("--dump") + 1])
for name in ("levels", "groups"):
    if fault == "ignores_" + name and "--" + name in args:
        at = args.index("--" + name)
        del args[at:at + 2]
if fault == "ignores_region": args = [a for a in args if not a.startswith("--region")]
if fault == "hangs": time.sleep(60)
done = subprocess.run([slf] + args, capture_output=True)
sys.stderr.buffer.write(done.stderr)
def edit_array(name, change):
    f = out / name
    if f.exists():
        data = bytearray(f.read_bytes())
        change(data)
        f.write_bytes(data)
def last(data): data[-1] ^= 1
def of_float(data): data[:] = data.replace(b"<i4", b"<f4", 1)
def of_other_shape(data): data[:] = re.sub(rb"\\((\\d+), (\\d+), 3,?\\)", rb"(\\2, \\1, 3)", data, count=1)
def in_fortran_order(data): data[:] = data.replace(b"'fortran_order': False", b"'fortran_order': True ", 1)
def shorter(data): del data[-4:]
def more_of(kind):
    f = out / (kind + ".npy")
    if not done.returncode and (not f.exists() or b"'shape': (0," in f.read_bytes()):
        header = b"{{'descr': '<u2', 'fortran_order': False, 'shape': (1, 2), }}".ljust(61)
        f.write_bytes(b"\\x93NUMPY\\1\\0" + bytes([len(header), 0]) + header + bytes(4))
if fault == "normals_too": more_of("octahedral")
if fault == "planes_too": more_of("planes")
if fault == "points_too": more_of("positions")
for kind in ("positions", "components", "planes", "octahedral"):
    if fault == "last_of_" + kind: edit_array(kind + ".npy", last)
    if fault == "no_" + kind and (out / (kind + ".npy")).exists(): (out / (kind + ".npy")).unlink()
for change in (of_float, of_other_shape, in_fortran_order, shorter):
    if fault == change.__name__: edit_array("components.npy", change)
f = out / "light_field.json"
if f.exists():
    header = json.loads(f.read_text())
    if fault == "no_header": f.unlink()
    elif fault == "header_is_no_json": f.write_text("{{")
    else:
        if fault == "partial": header["partial"] = not header["partial"]
        if fault == "points": header["points"] += 1
        if fault.startswith("header_"):
            key = fault[7:]
            value = header.get(key)
            if isinstance(value, bool): header[key] = not value
            elif isinstance(value, (int, float)): header[key] = value + 1
            elif isinstance(value, str): header[key] = value + "x"
            elif isinstance(value, list): header[key] = value[:-1]
            elif isinstance(value, dict): header[key] = {{k: None for k in value}}
        f.write_text(json.dumps(header))
if done.returncode:
    if fault == "never_refuses": sys.exit(0)
    if fault == "dies_on_error": os.abort()
    if fault == "leaves_output": out.mkdir(exist_ok=True); (out / "part.npy").write_bytes(b"")
if fault == "always_refuses": sys.exit(1)
sys.exit(done.returncode)
"""

NORMALS, TRANSFORM, BEGINNING, REFLECTED = "small-alone", "transforms-apart", "beginning-8", "header-order-2"
STREAMS = {f"streams/{name}" for name in (NORMALS, TRANSFORM, BEGINNING, REFLECTED, "no-slices", "two-points")}
FEW = {f"streams/{name}" for name in (REFLECTED, "two-points")}
REFUSED = {f"refused/{name}" for name in ("crc", "slices-longer", "end-count")}


def run(fault, *extra, cases=None):
    """The report of the runner on a decoder with a fault, in all cases if none are given."""
    with tempfile.TemporaryDirectory() as folder:
        wrapper = pathlib.Path(folder) / "decoder.py"
        wrapper.write_text(WRAPPER.format(slf=SLF, fault=fault))
        only = [word for case in sorted(cases or STREAMS | REFUSED) for word in ("--only", case)]
        done = subprocess.run([sys.executable, str(HERE / "run.py"), "--json", *only, "--decoder",
                               f"{sys.executable} {wrapper} decode {{in}} --dump {{out}} {{options}}", *extra],
                              capture_output=True, text=True)
        report = json.loads(done.stdout)
        assert (done.returncode == 0) == (report["failed"] == 0), fault
        return report


def failures(fault, *extra, cases=None):
    """The cases that a fault fails."""
    return {c["case"] for c in run(fault, *extra, cases=cases)["cases"] if c["verdict"] == "failed"}


def expecting(key):
    """The cases that expect something, in one of the requests."""
    cases = {case: json.loads((HERE / case / "case.json").read_text(encoding="utf-8"))["expect"] for case in STREAMS}
    return {case for case, expect in cases.items() if any(e.get(key) for e in expect if e["points"])}


def check(name, got, wanted):
    global passed
    assert got == wanted and wanted or name == "none" and not got, f"{name}: {sorted(got)} instead of {sorted(wanted)}"
    passed += 1


passed = 0
with_points = STREAMS - {"streams/no-slices"}
check("none", failures("none", "--messages"), set())
for kind, wanted in (("positions", with_points), ("components", with_points), ("planes", expecting("planes_sha256")),
                     ("octahedral", expecting("normals_sha256"))):
    check(f"last_of_{kind}", failures(f"last_of_{kind}"), wanted)
    check(f"no_{kind}", failures(f"no_{kind}"), wanted)
for fault in ("of_float", "in_fortran_order", "shorter", "of_other_shape"):
    check(fault, failures(fault, cases=FEW), FEW)
for option in ("levels", "groups", "region"):
    check(f"ignores_{option}", failures(f"ignores_{option}") & with_points, expecting(option))
for fault in ("no_header", "header_is_no_json", "partial", "points", "header_grid", "header_up", "header_right_handed",
              "header_metres_per_unit", "header_num_functions", "header_shift", "header_has_basis", "header_normal_bits"):
    check(fault, failures(fault, cases=FEW), FEW)
for key in ("basis", "directions", "normal_cell", "colour", "transfer", "gamma_range"):
    check(f"header_{key}", failures(f"header_{key}", cases=FEW), {f"streams/{REFLECTED}"})
check("never_refuses", failures("never_refuses", cases=FEW | REFUSED), REFUSED)
check("dies_on_error", failures("dies_on_error", cases=FEW | REFUSED), REFUSED)
check("leaves_output", failures("leaves_output", cases=FEW | REFUSED), REFUSED)
check("normals_too", failures("normals_too"), STREAMS - expecting("normals_sha256"))
check("planes_too", failures("planes_too"), STREAMS - expecting("planes_sha256"))
check("points_too", failures("points_too"), STREAMS - with_points)
for program, wanted in (("true", FEW | REFUSED), ("false", FEW)):      # nothing; a refusal of everything
    check(program, failures("none", "--decoder", program, cases=FEW | REFUSED), wanted)
check("always_refuses", failures("always_refuses", cases=FEW | REFUSED), FEW)
check("hangs", failures("hangs", "--timeout", "0.3", cases=FEW | REFUSED), FEW | REFUSED)

# Messages: the element of every refusal.
with tempfile.TemporaryDirectory() as folder:
    silent = pathlib.Path(folder) / "silent.py"
    silent.write_text(f"import subprocess, sys\nsys.exit(subprocess.run([{SLF!r}] + sys.argv[1:], stderr=subprocess.DEVNULL).returncode)")
    command = f"{sys.executable} {silent} decode {{in}} --dump {{out}} {{options}}"
    check("says_nothing", failures("none", "--messages", "--decoder", command, cases=FEW | REFUSED), REFUSED)

# Colours: 1/16 of a grey level is allowed, a fifteenth not; two numbers are no colour.
colours = json.loads((HERE / "meaning.json").read_text(encoding="utf-8"))[REFLECTED]["radiance"]
with tempfile.TemporaryDirectory() as folder:
    for error, wanted in ((0.06, set()), (1 / 15, {f"streams/{REFLECTED}"}), (float("nan"), {f"streams/{REFLECTED}"}),
                          (None, {f"streams/{REFLECTED}"})):
        table = pathlib.Path(folder) / "colour.py"
        table.write_text(f"import sys\nfor c in {colours!r}:\n"
                         "    if [c['point'], *c['direction']] == [int(sys.argv[1]), *map(float, sys.argv[2:])]:\n"
                         f"        print('colour', *[v + float('{error or 0}') for v in c['rgb']][:{2 if error is None else 3}])\n")
        got = failures("none", "--radiance", f"{sys.executable} {table} {{point}} {{x}} {{y}} {{z}}", cases=FEW)
        assert got == wanted, (error, got)
        passed += 1

# The report for continuous integration says the same.
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "report.xml"
    report = run("no_octahedral", "--junit", str(path), "--skip", "streams/two-points")
    suite = xml.parse(path).getroot()
    wrong = sorted(name.split("/")[1] for name in expecting("normals_sha256"))
    assert [int(suite.get(key)) for key in ("tests", "failures", "skipped")] == [len(STREAMS | REFUSED), len(wrong), 1]
    failed = [case.get("name") for case in suite if case.find("failure") is not None]
    assert failed == wrong and report["failed"] == len(wrong), failed
    assert [case.get("name") for case in suite if case.find("skipped") is not None] == ["two-points"]
    passed += 1
print(f"{passed} passed, 0 failed")
