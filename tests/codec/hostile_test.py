#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What hostile files cost: a refusal of a file below 1 kB at most 16 MiB and 50 ms beyond a program that does
nothing, whatever they claim; others stay within the limits they are given. Judges exit codes, memory and time.
Time is that of the processor, so that others on the machine do not count, the best of three where one was too long.

    tests/codec/hostile_test.py SLF HOSTILE_STREAMS
"""
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MEBIBYTE = 1 << 20
MOST_BEYOND = 16 * MEBIBYTE
MOST_SECONDS_BEYOND = 0.05
REFUSALS = {2, 4, 5, 6}  # --max-bytes and the like; invalid, limit, unsupported
LIMIT = 5


def run(command, out=None):
    """Exit code, peak of the resident set in bytes, seconds of the processor, what was said; a child's peak begins with ours so far."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdout=out or said, stderr=said, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return process.returncode, usage.ru_maxrss * 1024, usage.ru_utime + usage.ru_stime, said.read()


class Judge:
    """Counts what was wrong."""

    def __init__(self, program):
        self.program = program
        nothing = [run([program, "--version"]) for _ in range(3)]
        self.base, self.base_seconds = nothing[0][1], min(seconds for _, _, seconds, _ in nothing)
        self.wrong, self.worst_bytes, self.worst_seconds, self.worst_small, self.count = [], 0, 0.0, 0.0, 0
        self.count_drawn, self.most_kept = 0, 0.0

    def check(self, good, what):
        """Notes a failure."""
        if not good:
            self.wrong.append(what)
            print("WRONG:", what)

    def refuses(self, file):
        """Every verb refuses it, cheaply."""
        with tempfile.TemporaryDirectory() as scratch:
            for verb in (["decode", file, "--dump", scratch + "/dump"],
                         ["render", file, "-o", scratch + "/out.png", "--size", "64x64"]):
                command = [self.program, *verb, "-j", "1"]
                code, peak, seconds, said = run(command)
                beyond, small = peak - self.base, pathlib.Path(file).stat().st_size < 1024
                seconds -= self.base_seconds
                for _ in range(2 if small and seconds > MOST_SECONDS_BEYOND else 0):
                    seconds = min(seconds, run(command)[2] - self.base_seconds)
                self.count += 1
                self.worst_bytes = max(self.worst_bytes, beyond)
                self.worst_seconds = max(self.worst_seconds, seconds)
                self.worst_small = max(self.worst_small, seconds if small else 0)
                self.check(code in REFUSALS, f"{verb[0]} {file}: exit code {code}")
                self.check(said.count(b"\n") <= 2, f"{verb[0]} {file}: more than a line")
                self.check(not small or seconds <= MOST_SECONDS_BEYOND, f"{verb[0]} {file}: {1000 * seconds:.0f} ms")
                self.check(not small or beyond <= MOST_BEYOND,
                           f"{verb[0]} {file}: {beyond / MEBIBYTE:.1f} MiB")
                self.check(not os.listdir(scratch), f"{verb[0]} {file}: left {os.listdir(scratch)}")

    def stays_within(self, file, limit):
        """Decoding takes what info says at most, and --max-memory below that refuses it."""
        with tempfile.TemporaryDirectory() as scratch:
            code, _, _, said = run([self.program, "info", file, "--json", "--quiet", "-j", "1"])
            self.check(code == 0, f"info {file}: exit code {code}")
            self.check(not re.search(rb"[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80\xae", said),
                       f"info --json {file}: control characters")
            most = int(re.search(rb'"memory_most": (\d+)', said).group(1))
            said = run([self.program, "info", file])[3]
            self.check(not re.search(rb"[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80\xae", said),
                       f"info {file}: control characters")
            verb = [self.program, "decode", file, "-o", scratch + "/out.ply", "-j", "1", "--quiet"]
            code, peak, seconds, said = run([*verb, "--max-memory", str(limit)])
            self.check(code == (LIMIT if most > limit else 0), f"decode {file}: exit code {code}, {most} {said}")
            print(f"{pathlib.Path(file).name}: {most / MEBIBYTE:.1f} MiB at most, "
                  f"{(peak - self.base) / MEBIBYTE:.1f} MiB with a limit of {limit / MEBIBYTE:.0f}, {seconds:.2f} s")
            code, peak, seconds, said = run([*verb])
            self.check(code in (0, LIMIT), f"decode {file}: exit code {code} {said}")
            self.check(code != 0 or peak - self.base <= 1.1 * most + MOST_BEYOND, f"decode {file}: {peak} bytes")

    def counts_all_that_is_kept(self, file):
        """Units and entries of an index count against --max-memory in every verb: a limit below them refuses, one above them holds."""
        with tempfile.TemporaryDirectory() as scratch:
            verbs = [["info"], ["info", "--json"], ["info", "--units"], ["info", "--syntax"], ["info", "--syntax", "--json"]]
            verbs += [[verb, "-o", scratch + "/x.slf", *more] for verb, *more in
                      (["truncate"], ["truncate", "--levels", "1"], ["truncate", "--max-bytes", "5000"], ["merge"])]
            verbs += [["decode", "-o", scratch + "/x.ply"], ["decode", "--frame", "0", "-o", scratch + "/y.ply"],
                      ["render", "-o", scratch + "/x.png"], ["export", "-o", scratch + "/z.ply"], ["html", "-o", scratch + "/x.html"]]
            for verb in verbs:
                for limit, expected in ((16, {LIMIT}), (128, {0, 2, 4, LIMIT})):
                    code, peak, _, said = run([self.program, verb[0], file, *verb[1:], "--max-memory", f"{limit}M"], subprocess.DEVNULL)
                    what = f"{' '.join(verb)} of {pathlib.Path(file).name} within {limit} MiB"
                    no_page = verb[0] == "html" and code == 6  # a build without the viewer's page
                    self.check(code in expected or no_page, f"{what}: exit code {code} {said[-200:]}")
                    self.check(peak - self.base <= limit * MEBIBYTE, f"{what}: {(peak - self.base) / MEBIBYTE:.0f} MiB")
                    self.most_kept = max(self.most_kept, (peak - self.base) / (limit * MEBIBYTE))

    def draws_no_nonsense(self, file):
        """Pictures and files of a grid anywhere: refused, or finite."""
        with tempfile.TemporaryDirectory() as scratch:
            outputs = [["render", file, "--size", "48x48", "-o", scratch + "/x.png"], ["decode", file, "-o", scratch + "/d.ply"],
                       ["export", file, "--mean", "-o", scratch + "/m.ply"]]
            outputs += [["export", file, "-o", f"{scratch}/x.{kind}"] for kind in ("ply", "glb", "spz", "sog")]
            for command in outputs:
                code, _, _, said = run([self.program, *command, "-j", "1"])
                made = pathlib.Path(command[-1])
                left_out = made.suffix == ".sog" and code == 6  # a build without libwebp
                self.check(code in (0, 4) or left_out, f"{command[0]} {made.name} of {file}: exit code {code} {said}")
                self.check(not re.search(rb"[ -](nan|inf)\b", said), f"{command[0]} of {file}: {said}")
                self.check(made.exists() == (code == 0), f"{command[0]} {made.name} of {file}: exit code {code}, {os.listdir(scratch)}")
                self.count_drawn += code == 0
                if code == 0 and made.suffix == ".ply":
                    self.check(floats_are_finite(made), f"{command[0]} {made.name} of {file}: not finite")


    def reads_in_proportion(self, folder):
        """Values of a capture's JSON take 16 bytes, while their list grows three times that, for two of the file."""
        text = "[" + "0," * (2 << 20) + "0]"
        pathlib.Path(folder, "cameras.json").write_text(text)
        code, peak, _, said = run([self.program, "encode", folder, "-o", folder + "/x.slf"])
        self.check(code == 4 and b"cameras.json" in said, f"cameras.json of zeros: exit code {code}, {said[:200]}")
        self.check(peak - self.base < 30 * len(text), f"cameras.json of zeros: {(peak - self.base) / len(text):.0f} bytes a byte")


def floats_are_finite(ply):
    """Is every property that is a float finite, in a binary PLY of one element?"""
    head, body = ply.read_bytes().split(b"end_header\n", 1)
    kinds = re.findall(rb"property (\w+) ", head)
    row = struct.Struct("<" + "".join({b"float": "f", b"double": "d", b"uchar": "B"}[kind] for kind in kinds))
    return len(body) > 0 and all(math.isfinite(value) for values in row.iter_unpack(body) for value in values)


def main():
    """All refused conformance streams, and the hostile ones."""
    judge = Judge(sys.argv[1])
    with tempfile.TemporaryDirectory() as made:
        subprocess.run([sys.argv[2], made], check=True, stdout=subprocess.DEVNULL)
        for name in ("units-300k", "index-300k"):  # first, while we are small
            judge.counts_all_that_is_kept(str(pathlib.Path(made, name + ".slf")))
        print(f"units and entries: at most {100 * judge.most_kept:.0f} % of the limit")
        files = sorted(ROOT.glob("conformance/refused/*/stream.slf")) + sorted(pathlib.Path(made, "refused").iterdir())
        for file in files:
            judge.refuses(str(file))
        for file in sorted(pathlib.Path(made).glob("*.slf")):
            judge.stays_within(str(file), 64 * MEBIBYTE)
        for file in sorted(pathlib.Path(made, "grids").iterdir()):
            judge.draws_no_nonsense(str(file))
        judge.reads_in_proportion(made)
        judge.check(30 < judge.count_drawn < 100, f"{judge.count_drawn} pictures and files of far grids")
    print(f"{judge.count} refusals: at most {judge.worst_bytes / MEBIBYTE:.1f} MiB and {judge.worst_seconds:.2f} s, "
          f"{1000 * judge.worst_small:.0f} ms below 1 kB; {len(judge.wrong)} wrong")
    return 1 if judge.wrong or judge.count < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
