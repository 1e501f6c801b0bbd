#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Moving clouds side by side with the G-PCC reference software (TMC13): geometry, and brightness at equal PSNR.

    frames_tmc3.py --tmc3 PROGRAM --bench build/tests/bench/bench_frames [--steps 8,16,32] [--qps 22,28,34,40] DIR ...

DIR is what `slf synth rot1 --frames N -o DIR` makes, on a grid of 8 bits. One group of all frames; bytes are means over all frames but the
first. TMC13 predicts geometry and reflectance from the frame before (interPredictionEnabled), without global motion, which its encoder
does not look for in objects; colours it does not predict at all, so brightness is its reflectance. Positions and reflectance are its payload
bytes as its log has them, ours are whole units. Brightness is (R + 2 G + B) / 4.
"""
import argparse
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

from tmc3 import ATTRIBUTE, GEOMETRY, read_ply, write_ply

SIDE = 256


def run(words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        sys.exit(f"{words[0]}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def frame_of(file):
    """Places [P, 3] and brightness [P], 0 .. 255."""
    ply = read_ply(file)
    red, green, blue = (ply[name].astype(int) for name in ("red", "green", "blue"))
    return np.round(np.stack([ply[axis] for axis in "xyz"], 1)).astype(int), np.round((red + 2 * green + blue) / 4).astype(int)


def error_of(given, decoded):
    """Mean square error of brightness; the places have to be the same."""
    places, values = given
    back = np.round(np.stack([decoded[axis] for axis in "xyz"], 1)).astype(int)
    mine, theirs = np.lexsort(places.T), np.lexsort(back.T)
    if len(back) != len(places) or (back[theirs] != places[mine]).any():
        sys.exit("tmc3 did not give the points back")
    name = next(name for name in decoded if name not in "xyz")
    return float(np.square(values[mine] - decoded[name][theirs].astype(float)).mean())


def tmc3_at(program, frames, qp):
    """(bytes of positions, of brightness, PSNR) a frame, without the first."""
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for n, (places, values) in enumerate(frames):
            write_ply(scratch / f"in_{n:04d}.ply", places, values)
        common = [f"--frameCount={len(frames)}", "--firstFrameNum=0"]
        box = ["--autoSeqBbox=0", "--seqOrigin=0,0,0", f"--seqSizeWhd={SIDE},{SIDE},{SIDE}"]
        inter = ["--interPredictionEnabled=1", f"--randomAccessPeriod={len(frames)}", "--globalMotionEnabled=0"]
        log = run([program, *GEOMETRY, *ATTRIBUTE, f"--qp={qp}", "--attribute=reflectance", *common, *box, *inter,
                   f"--uncompressedDataPath={scratch}/in_%04d.ply", f"--compressedStreamPath={scratch}/x.bin"])
        run([program, "--mode=1", *common, f"--compressedStreamPath={scratch}/x.bin", f"--reconstructedDataPath={scratch}/out_%04d.ply"])
        errors = [error_of(frame, read_ply(scratch / f"out_{n:04d}.ply")) for n, frame in enumerate(frames)]
    sizes = [[int(size) for size in re.findall(rf"^{what} bitstream size (\d+) B", log, re.M)] for what in ("positions", "reflectances?")]
    if any(len(size) != len(frames) for size in sizes):
        sys.exit(f"tmc3's log has sizes of {[len(size) for size in sizes]} frames, not of {len(frames)}")
    return (*(sum(size[1:]) / (len(frames) - 1) for size in sizes), psnr(sum(errors[1:]) / (len(frames) - 1)))


def psnr(error):
    return 10 * math.log10(255 ** 2 / max(error, 1e-12))


def ours_at(bench, directory, step):
    """{alone, predicted: (bytes of geometry, of brightness, PSNR)}"""
    rows = {line[:12].strip(): line[12:].split() for line in run([bench, "--brightness", step, directory]).splitlines() if line.startswith("  ")}
    return {name: tuple(float(rows[key][i]) for i in (1, 2, 3)) for name, key in (("alone", "by itself"), ("predicted", "predicted"))}


def bytes_at(curve, decibels):
    """Bytes where a curve [(bytes, dB)] has so many, on a line of logarithms; None beyond it."""
    curve = sorted(curve, key=lambda point: point[1])
    if not curve[0][1] <= decibels <= curve[-1][1]:
        return None
    return math.exp(np.interp(decibels, [p for _, p in curve], [math.log(size) for size, _ in curve]))


def compared(ours, theirs):
    """Change of bytes against theirs, mean over our points within their curve; None where there is none."""
    changes = [size / other - 1 for size, decibels in ours if (other := bytes_at(theirs, decibels))]
    return sum(changes) / len(changes) if changes else None


def percent(change):
    return "" if change is None else f"{100 * change:+.1f} %".replace("-", "−")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tmc3", required=True)
    parser.add_argument("--bench", required=True)
    parser.add_argument("--steps", default="8,16,32")
    parser.add_argument("--qps", default="22,28,34,40")
    parser.add_argument("directories", nargs="+", type=pathlib.Path)
    given = parser.parse_args()
    print("| sequence | geometry: TMC13, bytes | ours | | brightness: TMC13, bytes, dB | ours, bytes, dB | at equal dB |\n" + "| --- " * 7 + "|")
    for directory in given.directories:
        frames = [frame_of(file) for file in sorted(directory.glob("*.ply"))]
        theirs = [tmc3_at(given.tmc3, frames, int(qp)) for qp in given.qps.split(",")]
        ours = [ours_at(given.bench, directory, int(step))["predicted"] for step in given.steps.split(",")]
        change = compared([row[1:] for row in ours], [row[1:] for row in theirs])
        cells = [", ".join(f"{size:,.0f} {decibels:.1f}" for _, size, decibels in rows) for rows in (theirs, ours)]
        print(f"| {directory.name} | {theirs[0][0]:,.0f} | {ours[0][0]:,.0f} | {percent(ours[0][0] / theirs[0][0] - 1)} | {cells[0]} | {cells[1]} | "
              f"{percent(change)} |", flush=True)


if __name__ == "__main__":
    main()
