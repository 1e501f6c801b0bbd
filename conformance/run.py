#!/usr/bin/env python3
"""Runs a decoder against the conformance streams.

    run.py --decoder "slf decode {in} --dump {out} {options}" [--info "slf info {in}"]

The decoder gets a stream {in}, a directory {out} and {options} ("--levels N", "--groups N", "--region=X0,Y0,Z0,X1,Y1,Z1",
"--planes" or nothing) and leaves positions.npy (int32 [P, 3]), components.npy (int32 [P, R, 3]), with --planes planes.npy
(int32 [P, K, 3]) and, where the stream has normals, octahedral.npy (uint16 [P, 2]) in {out}. It must exit with 0 on streams/, and with another code,
not by a signal and not after the time limit, on refused/. With --messages the name of the refused syntax
element must be in what it prints. Needs Python 3 alone. Exit code: 0 all passed, 1 some failed, 2 usage.
"""
import argparse, hashlib, json, pathlib, re, shlex, shutil, struct, subprocess, sys, tempfile


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
            words.append(word.replace("{in}", values["in"]).replace("{out}", values["out"]))
    return subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout)


def check_stream(folder, decoder, timeout):
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    stream = folder / case["stream"]["file"]
    if hashlib.sha256(stream.read_bytes()).hexdigest() != case["stream"]["sha256"]:
        return ["the stream itself is not the one of the manifest"]
    problems = []
    for expect in case["expect"]:
        out = pathlib.Path(tempfile.mkdtemp())
        options = [w for name in ("levels", "groups") if expect[name] for w in ("--" + name, str(expect[name]))]
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
                if digest is None or 0 in shape:
                    continue
                path = out / ("octahedral.npy" if name == "normals" else name + ".npy")
                problem = check_array(path, descr, shape, digest)
                if problem:
                    problems.append(f"{where}: {problem}")
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
        done = run(command, {"in": str(folder / case["stream"]["file"]), "out": str(out), "options": []}, timeout)
        printed = done.stderr.decode(errors="replace")
        if done.returncode == 0:
            return ["was decoded without an error"]
        if done.returncode < 0:
            return [f"died of signal {-done.returncode}"]
        if messages and refuse["element"] not in printed:
            return [f"the message does not name {refuse['element']}: {printed.strip()}"]
        if any(out.iterdir()):
            return ["left output behind"]
    except (OSError, subprocess.TimeoutExpired) as error:
        return [str(error)]
    finally:
        shutil.rmtree(out, ignore_errors=True)
    return []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--decoder", required=True)
    parser.add_argument("--info", help="reads headers and metadata; cases only it can refuse are skipped without it")
    parser.add_argument("--suite", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent)
    parser.add_argument("--messages", action="store_true")
    parser.add_argument("--skip", action="append", default=[], metavar="CASE", help='e.g. "streams/draco"; repeatable')
    parser.add_argument("--timeout", type=float, default=60, metavar="SECONDS", help="for one run [60]")
    parser.add_argument("--json", action="store_true", help="a report on standard output")
    arguments = parser.parse_args()
    report = []
    for part in ("streams", "refused"):
        for folder in sorted(p for p in (arguments.suite / part).iterdir() if p.is_dir()):
            if f"{part}/{folder.name}" in arguments.skip:
                problems = None
            elif part == "streams":
                problems = check_stream(folder, arguments.decoder, arguments.timeout)
            else:
                problems = check_refused(folder, arguments.decoder, arguments.info, arguments.messages, arguments.timeout)
            verdict = "skipped" if problems is None else "failed" if problems else "passed"
            report.append({"case": f"{part}/{folder.name}", "verdict": verdict, "problems": problems or []})
            for problem in problems or []:
                print(f"{part}/{folder.name}: {problem}", file=sys.stderr)
    count = {v: sum(r["verdict"] == v for r in report) for v in ("passed", "failed", "skipped")}
    if arguments.json:
        print(json.dumps({"cases": report, **count}, indent=1))
    else:
        print(f"conformance: {count['passed']} passed, {count['failed']} failed, {count['skipped']} skipped")
    return 1 if count["failed"] or not report or not count["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
