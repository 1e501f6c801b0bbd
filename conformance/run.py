#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a decoder against the conformance streams.

    run.py --decoder "slf decode {in} --dump {out} {options}" [--info "slf info {in}"]

The decoder gets a stream {in}, a directory {out} and {options} ("--levels N", "--groups N", "--layers N", "--frame N", "--region=X0,Y0,Z0,X1,Y1,Z1",
"--planes" or nothing; a region is in units of the world, put on the grid as spec 6.1 puts points) and leaves
positions.npy (int32 [P, 3]), components.npy (int32 [P, R, 3]), with --planes planes.npy (int32 [P, K, 3]),
where the stream has normals, octahedral.npy (uint16 [P, 2]) and, but for --without-header, light_field.json in
{out}: an object with points, partial and the keys and values of "header" in meaning.json, others beside them; numbers to 1e-6 of
themselves. It must exit with 0 on streams/, and with another code,
not by a signal and not after the time limit, on refused/ and, for the frame that it is given, on refused_frames/. Of a stream of several
frames "--frame N" asks for the one at place N, from 0 on, and for whatever else the options say of it; without it for the first.
With --messages the names of the refused syntax element and of its unit must be in what it prints.
With --radiance "CMD {in} {out} {point} {x} {y} {z}" a command that prints, as the last three
numbers, R, G, B of a point towards (x, y, z), from the stream or from what the decoder left in {out}: within 1/16 (spec 6.7).
Needs Python 3 alone. Exit code: 0 all passed, 1 some failed, 2 usage.
"""
import argparse, concurrent.futures, hashlib, json, math, pathlib, re, shlex, shutil, struct, subprocess, sys, tempfile
import xml.etree.ElementTree as xml

GREY_LEVELS = 1 / 16                        # of a colour, spec 6.7


def npy(path):
    """Type, shape and bytes of an .npy file."""
    data = path.read_bytes()
    if data[:6] != b"\x93NUMPY":
        raise ValueError(f"{path.name} is not an .npy file")
    size, start = (struct.unpack("<H", data[8:10])[0], 10) if data[6] == 1 else (struct.unpack("<I", data[8:12])[0], 12)
    header = data[start:start + size].decode("latin-1")
    descr = re.search(r"'descr':\s*'([^']+)'", header).group(1)
    shape = tuple(int(n) for n in re.search(r"'shape':\s*\(([^)]*)\)", header).group(1).replace(" ", "").split(",") if n)
    if "True" in header.split("fortran_order")[1][:12]:
        raise ValueError(f"{path.name} is in Fortran order")
    return descr, shape, data[start + size:]


def check_array(path, descr, shape, digest):
    got_descr, got_shape, body = npy(path)
    if got_descr != descr or got_shape != shape:
        return f"{path.name}: {got_descr} {got_shape} instead of {descr} {shape}"
    if hashlib.sha256(body).hexdigest() != digest:
        return f"{path.name}: other values than expected"
    return None


def run(command, values, timeout):
    """Words are split first and filled in after, so paths may hold spaces."""
    words = []
    for word in shlex.split(command):
        if word == "{options}":
            words += values["options"]
        else:
            for name, value in values.items():
                word = word.replace("{" + name + "}", str(value))
            words.append(word)
    return subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout)


def differences(wanted, got, place=""):
    """Where an object lacks what another has, or has it otherwise."""
    if isinstance(wanted, dict) and isinstance(got, dict):
        for key, value in wanted.items():
            name = f"{place}.{key}" if place else key
            yield from differences(value, got[key], name) if key in got else [f"{name} is missing"]
    elif isinstance(wanted, list) and isinstance(got, list) and len(wanted) == len(got):
        for i, pair in enumerate(zip(wanted, got)):
            yield from differences(*pair, f"{place}[{i}]")
    elif isinstance(wanted, float) and not isinstance(got, bool) and isinstance(got, (int, float)):
        if not math.isclose(wanted, got, rel_tol=1e-6, abs_tol=1e-300):
            yield f"{place}: {got} instead of {wanted}"
    elif wanted != got or isinstance(wanted, bool) != isinstance(got, bool):
        yield f"{place}: {got} instead of {wanted}"


def check_header(out, expect, header):
    """light_field.json; the header is that of the whole light field."""
    got = json.loads((out / "light_field.json").read_text(encoding="utf-8"))
    wanted = {"partial": expect["partial"], "points": expect["points"]}
    whole = not expect["levels"] and not expect["groups"] and "region" not in expect
    return [f"light_field.json: {each}" for each in differences({**wanted, **(header if whole else {})}, got)]


def check_radiance(command, values, colours, timeout):
    """Colours of points along directions."""
    problems = []
    for colour in colours:
        x, y, z = colour["direction"]
        done = run(command, {**values, "point": colour["point"], "x": x, "y": y, "z": z}, timeout)
        numbers = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|nan", done.stdout.decode(errors="replace"))
        got = [float(number) for number in numbers[-3:]]
        if done.returncode or len(got) < 3:
            problems.append(f"radiance: exit code {done.returncode}, {len(numbers)} numbers")
        elif not all(abs(a - b) <= GREY_LEVELS for a, b in zip(got, colour["rgb"])):
            problems.append(f"radiance of point {colour['point']} towards {x} {y} {z}: {got} instead of {colour['rgb']}")
    return problems


def check_stream(folder, decoder, timeout, meaning, radiance):
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    stream = folder / case["stream"]["file"]
    if hashlib.sha256(stream.read_bytes()).hexdigest() != case["stream"]["sha256"]:
        return ["the stream itself is not the one of the manifest"]
    problems = []
    for expect in case["expect"]:
        out = pathlib.Path(tempfile.mkdtemp())
        options = [w for name in ("levels", "groups", "layers", "frame") if expect.get(name) for w in ("--" + name, str(expect[name]))]
        options += ["--region=" + ",".join(map(str, expect["region"]))] if "region" in expect else []
        options += ["--planes"] if "planes_sha256" in expect else []
        where = " ".join(options) or "whole"
        try:
            done = run(decoder, {"in": str(stream), "out": str(out), "options": options}, timeout)
            if done.returncode != 0:
                problems.append(f"{where}: exit code {done.returncode}: {done.stderr.decode(errors='replace').strip()}")
                continue
            points = expect["points"]
            wanted = [("positions", "<i4", (points, 3)), ("components", "<i4", (points, expect["components"], 3)),
                      ("planes", "<i4", (points, expect["functions"], 3)), ("normals", "<u2", (points, 2))]
            for name, descr, shape in wanted:
                digest = expect.get(name + "_sha256")
                path = out / ("octahedral.npy" if name == "normals" else name + ".npy")
                if digest is None or 0 in shape:
                    if path.exists() and 0 not in npy(path)[1]:
                        problems.append(f"{where}: {path.name} of what is not there")
                    continue
                problem = check_array(path, descr, shape, digest)
                if problem:
                    problems.append(f"{where}: {problem}")
            if meaning is not None:
                found = meaning.get(folder.name, {})
                problems += [f"{where}: {each}" for each in check_header(out, expect, found.get("header", {}))]
                if radiance and where == "whole":
                    values = {"in": str(stream), "out": str(out), "options": []}
                    problems += check_radiance(radiance, values, found.get("radiance", []), timeout)
        except (OSError, ValueError, AttributeError, struct.error, subprocess.TimeoutExpired) as error:
            problems.append(f"{where}: {error}")
        finally:
            shutil.rmtree(out, ignore_errors=True)
    return problems


def check_refused(folder, decoder, info, messages, timeout):
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    refuse = case["refuse"]
    command = info if refuse["by"] == "info" else decoder
    if command is None:
        return None
    out = pathlib.Path(tempfile.mkdtemp())
    try:
        options = ["--frame", str(refuse["frame"])] if "frame" in refuse else []
        done = run(command, {"in": str(folder / case["stream"]["file"]), "out": str(out), "options": options}, timeout)
        printed = done.stderr.decode(errors="replace")
        if done.returncode == 0:
            return ["was decoded without an error"]
        if done.returncode < 0:
            return [f"died of signal {-done.returncode}"]
        for name in (refuse["element"], f"{refuse['unit']} unit" if refuse["unit"] else "") if messages else ():
            if name not in printed:
                return [f"the message does not name {name}: {printed.strip()}"]
        if any(out.iterdir()):
            return ["left output behind"]
    except (OSError, subprocess.TimeoutExpired) as error:
        return [str(error)]
    finally:
        shutil.rmtree(out, ignore_errors=True)
    return []


def write_junit(path, report):
    """The report as JUnit's XML, which continuous integration shows."""
    suite = xml.Element("testsuite", name="conformance", tests=str(len(report)))
    for name in ("failed", "skipped"):
        suite.set("failures" if name == "failed" else name, str(sum(r["verdict"] == name for r in report)))
    for entry in report:
        part, name = entry["case"].split("/")
        case = xml.SubElement(suite, "testcase", classname=f"conformance.{part}", name=name)
        if entry["verdict"] == "failed":
            xml.SubElement(case, "failure", message=entry["problems"][0]).text = "\n".join(entry["problems"])
        elif entry["verdict"] == "skipped":
            xml.SubElement(case, "skipped")
    xml.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def check(folder, arguments, meaning):
    """What is wrong with the decoder in a case; None where it is skipped."""
    case = f"{folder.parent.name}/{folder.name}"
    if case in arguments.skip:
        return None
    if folder.parent.name != "streams":
        return check_refused(folder, arguments.decoder, arguments.info, arguments.messages, arguments.timeout)
    radiance = None if case in arguments.without_colours else arguments.radiance
    return check_stream(folder, arguments.decoder, arguments.timeout, meaning, radiance)


def digests_of(suite, report):
    """How many digests the streams have that passed: so many were compared."""
    passed = [suite / entry["case"] / "case.json" for entry in report if entry["verdict"] == "passed" and entry["case"].startswith("streams/")]
    return sum(key.endswith("_sha256") for file in passed for expect in json.loads(file.read_text(encoding="utf-8"))["expect"] for key in expect)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--decoder", required=True)
    parser.add_argument("--info", help="reads headers and metadata; cases only it can refuse are skipped without it")
    parser.add_argument("--suite", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent)
    parser.add_argument("--messages", action="store_true")
    parser.add_argument("--skip", action="append", default=[], metavar="CASE", help='e.g. "streams/draco"; repeatable')
    parser.add_argument("--timeout", type=float, default=60, metavar="SECONDS", help="for one run [60]")
    parser.add_argument("--json", action="store_true", help="a report on standard output")
    parser.add_argument("--junit", metavar="FILE", help="a report for continuous integration")
    parser.add_argument("--radiance", metavar="CMD", help="prints the colour of a point; without it colours are not compared")
    parser.add_argument("--without-colours", action="append", default=[], metavar="CASE", help="no --radiance there; repeatable")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="cases at a time [1]")
    parser.add_argument("--without-header", action="store_true", help="the decoder leaves no light_field.json")
    parser.add_argument("--only", action="append", default=[], metavar="CASE", help="these cases alone; repeatable")
    arguments = parser.parse_args()
    report, meaning = [], None
    if not arguments.without_header:
        meaning = json.loads((arguments.suite / "meaning.json").read_text(encoding="utf-8"))
    folders = [f for part in ("streams", "refused", "refused_frames") for f in sorted((arguments.suite / part).glob("*/"))
               if not arguments.only or f"{part}/{f.name}" in arguments.only]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for folder, problems in zip(folders, pool.map(lambda folder: check(folder, arguments, meaning), folders)):
            case = f"{folder.parent.name}/{folder.name}"
            verdict = "skipped" if problems is None else "failed" if problems else "passed"
            report.append({"case": case, "verdict": verdict, "problems": problems or []})
            for problem in problems or []:
                print(f"{case}: {problem}", file=sys.stderr)
    count = {v: sum(r["verdict"] == v for r in report) for v in ("passed", "failed", "skipped")}
    if arguments.junit:
        write_junit(arguments.junit, report)
    if arguments.json:
        print(json.dumps({"cases": report, "digests": digests_of(arguments.suite, report), **count}, indent=1))
    else:
        print(f"conformance: {count['passed']} passed, {count['failed']} failed, {count['skipped']} skipped")
    return 1 if count["failed"] or not report or not count["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
