#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""One 8-bit colour per point against the RAHT of G-PCC's reference software.

    tests/bench/bench_colours.py SLF CLOUD.ply...      clouds named as in TMC13 below

Opponent planes (orthonormal, 16ths of a grey level) through `slf pack`; bytes are those of the coefficient
units, as TMC13's are of its attribute; PSNR is of the colours rounded back to 8 bits. BD-rate (PCHIP) of
luma (BT.709) and of R, G and B together. TMC13 v23.0-rc2: octree-raht-ctc lossless-geom-lossy-attrs,
rahtPredictionSearchRange 50000, qpChromaOffset -1, QP 22, 28, 34, 40, 46, 51, measured on the same clouds.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "tools" / "rd"))
from bd import bd_rate  # noqa: E402

TMC13 = {  # bytes, Y-PSNR, RGB-PSNR
    "can8tilt": [(31124, 41.54, 39.37), (19329, 37.42, 35.04), (10791, 33.18, 30.73), (5105, 28.79, 26.64),
                 (1955, 24.80, 23.17), (798, 22.11, 20.74)],
    "die8": [(5957, 43.89, 43.49), (4064, 39.98, 39.79), (2603, 35.32, 35.31), (1464, 30.45, 30.49),
             (634, 25.84, 25.92), (318, 23.23, 23.29)],
    "can10sparse": [(28075, 41.42, 39.49), (18292, 37.83, 35.54), (11054, 33.62, 31.14), (5811, 29.32, 26.84),
                    (2134, 24.63, 22.95), (823, 21.72, 20.43)],
    "dragonv9": [(55381, 40.06, 38.35), (25181, 35.77, 34.50), (10679, 32.23, 31.23), (4728, 29.27, 28.47),
                 (1925, 26.33, 25.76), (883, 24.08, 23.73)],
}
STEPS = [200, 400, 800, 1600, 3200, 5600]  # about the PSNR of those QPs
SCALE = 16
OPPONENT = np.array([[1, 1, 1], [1, 0, -1], [-1, 2, -1]]) / np.sqrt([[3], [2], [6]])
LUMA = np.array([0.2126, 0.7152, 0.0722])


def read_cloud(path):
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    points = int(header.split(b"element vertex ")[1].split()[0])
    row = np.dtype([("p", "<f4", 3), ("c", "u1", 3)])
    rows = np.frombuffer(body, row, points)
    return rows["p"].astype(np.int32), rows["c"].astype(float)


def sorted_rows(positions, values):
    order = np.lexsort(positions.T)
    return values[order]


def psnr(error):
    return 10 * np.log10(255 ** 2 / np.mean(error ** 2))


def coded(slf, folder, positions, colours, step, options):
    """Bytes of the coefficient units, Y-PSNR, RGB-PSNR."""
    subprocess.run([slf, "pack", folder / "positions.npy", folder / "components.npy", "-o", folder / "c.slf",
                    "--step", str(step), "--no-digest", "--quiet", *options], check=True)
    info = json.loads(subprocess.run([slf, "info", folder / "c.slf", "--json"], check=True, capture_output=True).stdout)
    size = sum(unit["bytes"] for unit in info["units"] if unit["type"] == "coefficients")
    subprocess.run([slf, "decode", folder / "c.slf", "--dump", folder / "d", "--quiet"], check=True)
    planes = sorted_rows(np.load(folder / "d" / "positions.npy"), np.load(folder / "d" / "components.npy")[:, 0])
    decoded = np.clip(np.rint(planes / SCALE @ OPPONENT), 0, 255)
    error = sorted_rows(positions, colours) - decoded
    return size, psnr(error @ LUMA), psnr(error)


def main(slf, *clouds):
    for cloud in map(Path, clouds):
        positions, colours = read_cloud(cloud)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            np.save(folder / "positions.npy", positions)
            np.save(folder / "components.npy", np.rint(colours @ OPPONENT.T * SCALE).astype(np.int32)[:, None])
            for options in ([], ["--rdo", "0.2"]):
                rows = [coded(slf, folder, positions, colours, step, options) for step in STEPS]
                anchor, test = np.array(TMC13[cloud.stem]).T, np.array(rows).T
                print(f"{cloud.stem:12} {' '.join(options):10}"
                      f" Y {bd_rate(anchor[0], anchor[1], test[0], test[1]):+6.1f} %"
                      f"  RGB {bd_rate(anchor[0], anchor[2], test[0], test[2]):+6.1f} %   ",
                      ", ".join(f"{int(b)} B {y:.2f} / {c:.2f}" for b, y, c in rows))


if __name__ == "__main__":
    main(*sys.argv[1:])
