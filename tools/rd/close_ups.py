#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Files beside a photograph: close_ups.py CAPTURE IMAGE X,Y -o OUT.png LABEL=PROGRAM:FILE...

One column for the photograph and one per file, each drawn by its own program, so that two versions of the
renderer can be compared. Rows: the view; four times as large around the pixel (X, Y); what rendering less
photograph is, four times as strong around grey."""
import argparse
import json
import pathlib
import subprocess
import tempfile

import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

ZOOM = 4


def border(picture):
    """What stands behind the object, as slf eval has it: the median of the photograph's edge."""
    edge = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    return ",".join(str(round(255 * float(v))) for v in np.median(edge, axis=0))


def rendered(program, file, capture, image, background, size, folder):
    out = pathlib.Path(folder) / "view.png"
    words = [program, "render", file, "--capture", capture, "--image", image, "-o", out, "--quiet",
             "--background", background]
    subprocess.run(words + (["--size", size] if size else []), check=True)
    return matplotlib.image.imread(out)[..., :3]


def photograph(capture, image):
    cameras = json.loads((pathlib.Path(capture) / "cameras.json").read_text(encoding="utf-8"))["cameras"]
    path = next(c["image"] for c in cameras if c["image"] == image)
    candidates = [pathlib.Path(capture) / path, pathlib.Path(capture) / "images" / path]
    return matplotlib.image.imread(next(p for p in candidates if p.exists()))[..., :3]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture")
    parser.add_argument("image")
    parser.add_argument("pixel")
    parser.add_argument("files", nargs="+", metavar="LABEL=PROGRAM:FILE")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--crop", type=int, default=64, help="pixels of the photograph across a close-up")
    given = parser.parse_args()
    x, y = (int(v) for v in given.pixel.split(","))
    was = photograph(given.capture, given.image)
    height, width = was.shape[:2]
    half = given.crop // 2
    x, y = np.clip(x, half, width - half), np.clip(y, half, height - half)
    columns = [("photograph", was, np.kron(was, np.ones((ZOOM, ZOOM, 1))), None)]
    with tempfile.TemporaryDirectory() as folder:
        for entry in given.files:
            label, rest = entry.split("=", 1)
            program, file = rest.split(":", 1)
            view = rendered(program, file, given.capture, given.image, border(was), None, folder)
            large = rendered(program, file, given.capture, given.image, border(was),
                             f"{ZOOM * width}x{ZOOM * height}", folder)
            columns.append((label, view, large, np.clip(128 / 255 + 4 * (view - was), 0, 1)))
    figure, axes = plt.subplots(3, len(columns), figsize=(2.8 * len(columns), 8.2), constrained_layout=True)
    for column, (label, view, large, error) in zip(axes.T, columns):
        rows = [view, large[ZOOM * (y - half):ZOOM * (y + half), ZOOM * (x - half):ZOOM * (x + half)], error]
        for axis, picture in zip(column, rows):
            axis.set_axis_off()
            if picture is not None:
                axis.imshow(picture, interpolation="nearest")
        column[0].set_title(label, fontsize=9)
    figure.savefig(given.output, dpi=110)


if __name__ == "__main__":
    main()
