#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Time, memory and bytes of scenes of growing size, coded slice by slice.

    scenes.py --slf build/bin/slf --work DIR [--points 100000,1000000,10000000] [--csv FILE] [--plot FILE]
              [-- settings of slf encode]

Makes terraces (slf synth terrace) with as many points a house whatever their size, 20 photographs and more,
keeps them in DIR, encodes each with --memory 2G and prints a row: user seconds and peak memory are those
of the process, as the system counts them. The exponent of user time over points is printed at the end.
"""
import argparse
import csv
import json
import math
import pathlib
import resource
import subprocess
import sys
import time

POINTS_OF_HOUSE = 166_000
COLUMNS = ["points", "photographs", "memory_mib", "slices", "wall_s", "user_s", "peak_mib", "bytes", "bits_per_point",
           "region_points", "region_user_s", "region_peak_mib"]


def run(words):
    """(standard output, wall seconds, user seconds, peak MiB) of a program."""
    begin, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["/usr/bin/env", "python3", "-c", CHILD, *words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(words)}: exit code {done.returncode}\n{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    out, _, peak = done.stdout.rpartition("\n")
    return out, time.monotonic() - begin, after.ru_utime - before.ru_utime, int(peak) / 1024


# Runs in a process of its own: ru_maxrss of children is that of the largest there ever was.
CHILD = """
import resource, subprocess, sys
code = subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL).returncode
print("\\n%d" % resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, end="")
sys.exit(code)
"""


def capture(slf, work, points):
    """A directory with a terrace of so many points; (path, photographs)."""
    houses = max(1, round(points / POINTS_OF_HOUSE))
    cameras = min(200, 20 + round(points / 55_000))
    path = work / f"terrace-{points}"
    if not (path / "cameras.json").exists():
        run([slf, "synth", "terrace", "-o", str(path), "--houses", str(houses), "--points", str(points), "--cameras",
             str(cameras), "--size", "800x600", "--quiet"])
    return path, cameras


def middle_box(slf, coded):
    """About the middle of the middle slice, a hundredth of the ground that all slices span, as --region takes it."""
    info = json.loads(run([slf, "info", str(coded), "--json"])[0])
    grid = info["header"]["grid"]
    boxes = [one["voxels"] for one in info["slice"]]
    span = [max(b[1][k] for b in boxes) - min(b[0][k] for b in boxes) for k in range(3)]
    box = boxes[len(boxes) // 2]
    low, high = [], []
    for k in range(3):
        middle, half = (box[0][k] + box[1][k]) / 2, span[k] / (2 if k == 2 else 20)
        low.append(grid["origin"][k] + grid["step"] * (middle - half))
        high.append(grid["origin"][k] + grid["step"] * (middle + half))
    return ",".join(f"{x:.3f}" for x in low + high)


def measure(slf, work, points, settings):
    path, cameras = capture(slf, work, points)
    coded = work / f"terrace-{points}.slf"
    out, wall, user, peak = run([slf, "encode", str(path), "-o", str(coded), "--memory", "2G", "--json", "--quiet",
                                 "--work", str(work / f"work-{points}"), *settings])
    report = json.loads(out)
    part = work / "region"
    said, _, region_user, region_peak = run([slf, "decode", str(coded), "--dump", str(part), "--region",
                                             middle_box(slf, coded), "--max-memory", "256M", "--json", "-j", "1"])
    size = coded.stat().st_size
    return [report["points"], cameras, 2048, report["slices"], round(wall, 1), round(user, 1), round(peak), size,
            round(8 * size / report["points"], 3), json.loads(said).get("points"), round(region_user, 2), round(region_peak)]


def exponent(rows):
    """Least squares of log time over log points."""
    x = [math.log(row[0]) for row in rows]
    y = [math.log(row[5]) for row in rows]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def plot(rows, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, left = plt.subplots(figsize=(6.4, 4))
    left.loglog([row[0] for row in rows], [row[5] for row in rows], "o-", label="user seconds")
    left.loglog([row[0] for row in rows], [row[6] for row in rows], "s--", label="peak memory, MiB")
    left.axhline(2048, color="grey", lw=0.8)
    left.set_xlabel("points")
    left.legend()
    left.grid(True, which="both", alpha=0.3)
    left.set_title(f"slf encode --memory 2G: time ~ points^{exponent(rows):.2f}")
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def main(words):
    settings = words[words.index("--") + 1:] if "--" in words else []
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slf", default="build/bin/slf")
    parser.add_argument("--work", required=True, type=pathlib.Path)
    parser.add_argument("--points", default="100000,1000000,10000000")
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--plot")
    given = parser.parse_args(words[:words.index("--")] if "--" in words else words)
    given.work.mkdir(parents=True, exist_ok=True)
    rows = []
    print(*COLUMNS, sep="\t")
    for points in map(int, given.points.split(",")):
        rows.append(measure(given.slf, given.work, points, settings))
        print(*rows[-1], sep="\t", flush=True)
        if given.csv:
            with open(given.csv, "w", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
    if len(rows) > 1:
        print(f"user seconds ~ points^{exponent(rows):.3f}")
        if given.plot:
            plot(rows, given.plot)


if __name__ == "__main__":
    main(sys.argv[1:])
