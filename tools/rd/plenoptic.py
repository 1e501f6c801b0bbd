#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plenoptic clouds: our planes and our view maps against RAHT-KLT as published.

    plenoptic.py --slf build/bin/slf --out DIR [CLOUD.ply ...] [--points 300000] [--rates 4,8,16,32,64] [--tmc3 PROGRAM]

Without clouds the can, the die and the vase are drawn. Writes DIR/plenoptic.json and prints a table: bits per point of geometry
(ours, for all) and colour, PSNR of Y, U, V (mean of the views' decibels; BT.709, peak 255), seconds of encoding, peak memory.
The own colour of a point (red, green, blue) is not judged. With the reference software of G-PCC (--tmc3) rows of one colour a point, the
mean of its views, stand beside: another input than N views. Below stand figures of others on the clouds of 8i."""
import argparse
import json
import multiprocessing
import pathlib
import resource
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import one_colour  # noqa: E402
from bd import NoFigure, bd_rate  # noqa: E402
from raht_klt import YUV, RahtKlt  # noqa: E402

SCENES = ["can", "die", "vase"]
TYPES = {"char": "i1", "uchar": "u1", "uint8": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
         "float": "<f4", "double": "<f8"}
# One colour a point, DeepRAHT on 8i's voxelised surface light fields (12 bits): bits per point, Y dB. Another input than N views.
ONE_COLOUR = {"longdress": (3096122, 0.391, 35.98), "loot": (3017285, 0.0806, 40.86), "redandblack": (2770567, 0.180, 39.51),
              "soldier": (4001754, 0.150, 38.42), "boxer": (3493085, 0.0700, 39.98), "Thaidancer": (3130215, 0.284, 37.44)}


def read_cloud(path):
    """Positions [P, 3] and the colours of views [P, N, 3] of a binary PLY without lists."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode("latin-1").split("\n")
    if "format binary_little_endian 1.0" not in lines:
        raise SystemExit(f"{path}: binary little endian alone is read here (slf encode and decode make one)")
    vertices = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    fields = [(line.split()[2], TYPES[line.split()[1]]) for line in lines if line.startswith("property")]
    rows = np.frombuffer(data, np.dtype(fields), vertices, end)
    views = [name for name, kind in fields if kind == "u1" and name not in ("red", "green", "blue")]
    positions = np.stack([rows[axis] for axis in "xyz"], 1).astype(np.int64)
    colours = np.empty((vertices, len(views), 1), np.uint8)
    for i, name in enumerate(views):
        colours[:, i, 0] = rows[name]
    return positions, colours.reshape(vertices, -1, 3)


def psnr_of(given, got):
    """Mean over views of the PSNR of Y, U, V."""
    views = []
    for v in range(given.shape[1]):
        error = (got[:, v].astype(np.float32) - given[:, v].astype(np.float32)) @ YUV.T.astype(np.float32)
        views.append(10 * np.log10(255 ** 2 / np.maximum((error.astype(np.float64) ** 2).mean(0), 1e-12)))
    return [float(x) for x in np.mean(views, 0)]


def row(cloud, points, codec, rate, geometry, colour, yuv, seconds, memory):
    return {"cloud": cloud, "points": points, "codec": codec, "rate": rate, "geometry_bits": geometry, "colour_bits": colour,
            "psnr_yuv": yuv, "seconds": seconds, "memory_mib": memory}


def ours(slf, cloud, out, way, rate, more=()):
    """One encode, judged by slf eval."""
    coded = out / "coded.slf"
    options = ["--as", way, *more] + ([] if rate is None else ["-q", str(rate)])
    before = time.monotonic()
    said = subprocess.run([slf, "encode", cloud, "-o", coded, "--json", "--quiet", *options], check=True, capture_output=True)
    seconds = time.monotonic() - before
    report = json.loads(said.stdout)
    said = subprocess.run([slf, "eval", coded, cloud, "--json", "--quiet"], check=True, capture_output=True)
    quality = json.loads(said.stdout)
    bits = report["bits_per_point"]
    return row(cloud.stem, report["points"], f"slf {way}", "exact" if rate is None else rate, bits["geometry"], bits["colour"],
               quality["coded"]["mean"], seconds, report["peak_memory_mib"])


def theirs(cloud, geometry, rates):
    """RAHT-KLT at some steps, in a process of its own: its memory is that of numpy, and not of what comes after."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(raht_klt_rows, (cloud, geometry, rates))


def raht_klt_rows(cloud, geometry, rates):
    positions, colours = read_cloud(cloud)
    before = time.monotonic()
    codec = RahtKlt(positions, colours)
    prepared = time.monotonic() - before
    rows = []
    for rate in rates:
        before = time.monotonic()
        bits, got = codec.coded(rate)
        seconds = prepared + time.monotonic() - before
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        rows.append(row(cloud.stem, len(positions), "RAHT-KLT", rate, geometry, bits / len(positions), psnr_of(colours, got),
                        seconds, memory))
    return rows


def tmc13_rows(program, cloud):
    """One colour a point, the mean of its views."""
    positions, colours = read_cloud(cloud)
    mean = np.round(colours.mean(1)).astype(np.uint8)
    rows = []
    for qp in one_colour.QPS:
        geometry, size, got, seconds = one_colour.coded(program, positions, mean, qp)
        rows.append(row(cloud.stem, len(positions), "TMC13, one colour", f"QP {qp}", 8 * geometry / len(positions), 8 * size / len(positions),
                        psnr_of(mean[:, None], got[:, None]), seconds, 0))
    return rows


def table(rows):
    lines = ["| cloud | points | codec | step | geometry, bits/point | colour, bits/point | Y | U | V | s | MiB |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    for r in rows:
        yuv = " | ".join("exact" if x is None else f"{x:.2f}" for x in r["psnr_yuv"])
        lines.append(f"| {r['cloud']} | {r['points']:,} | {r['codec']} | {r['rate']} | {r['geometry_bits']:.2f} | "
                     f"{r['colour_bits']:.2f} | {yuv} | {r['seconds']:.1f} | {r['memory_mib']:.0f} |")
    return "\n".join(lines)


def bd_rates(rows):
    """Colour bits at equal Y against RAHT-KLT, per cloud."""
    lines = ["| cloud | codec | colour bits at equal Y, against RAHT-KLT |", "|---|---|---|"]
    curves = {}
    for r in rows:
        if r["rate"] != "exact":
            curve = curves.setdefault((r["cloud"], r["codec"]), ([], []))
            curve[0].append(r["colour_bits"])
            curve[1].append(r["psnr_yuv"][0])
    for (cloud, codec), curve in curves.items():
        if codec in ("RAHT-KLT", "TMC13, one colour"):
            continue
        try:
            figure = f"{bd_rate(*curves[cloud, 'RAHT-KLT'], *curve):+.1f} %"
        except NoFigure as why:
            figure = str(why)
        lines.append(f"| {cloud} | {codec} | {figure} |")
    return "\n".join(lines)


def of_others():
    lines = ["One colour a point (not N views) of 8i's clouds, DeepRAHT:", "", "| cloud | points | bits/point | Y |",
             "|---|---|---|---|"]
    return "\n".join(lines + [f"| {name} | {n:,} | {bits} | {y} |" for name, (n, bits, y) in ONE_COLOUR.items()])


def clouds_of(given, out):
    if given.clouds:
        return [pathlib.Path(c) for c in given.clouds]
    made = []
    for scene in given.scenes.split(","):
        made.append(out / f"{scene}.ply")
        if not made[-1].exists():
            subprocess.run([given.slf, "synth", scene, "--plenoptic", str(given.views), "--points", str(given.points), "-o",
                            made[-1], "--quiet"], check=True)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clouds", nargs="*")
    parser.add_argument("--slf", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--points", type=int, default=300000)
    parser.add_argument("--views", type=int, default=13)
    parser.add_argument("--rates", default="4,8,16,32,64")
    parser.add_argument("--tmc3", help="the reference software of G-PCC")
    parser.add_argument("--no-view-maps", action="store_true", help="they take ten times as long")
    given = parser.parse_args()
    out = pathlib.Path(given.out)
    out.mkdir(parents=True, exist_ok=True)
    rates = [float(r) for r in given.rates.split(",")]
    rows = []
    for cloud in clouds_of(given, out):
        rows.append(ours(given.slf, cloud, out, "planes", None))
        rows += [ours(given.slf, cloud, out, "planes", rate) for rate in rates]
        if not given.no_view_maps:
            rows += [ours(given.slf, cloud, out, "viewmaps", rate) for rate in rates]
        rows += theirs(cloud, rows[-1]["geometry_bits"], rates)
        rows += tmc13_rows(given.tmc3, cloud) if given.tmc3 else []
        (out / "plenoptic.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    print(table(rows), bd_rates(rows), of_others(), sep="\n\n")


if __name__ == "__main__":
    main()
