#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the beginning of a file shows: prefixes.py FILE.slf -o OUT.png [--slf PROGRAM]

A column for each share of the bytes, in rows two views of an orbit: the light on the object shows where colours
depend on direction."""
import argparse
import pathlib
import subprocess
import tempfile

import matplotlib.image
import matplotlib.pyplot as plt

SHARES = (0.01, 0.02, 0.05, 0.10, 0.25, 0.50, 1.0)
SIZE = 320


def views(program, file, max_bytes, azimuths, folder):
    """Pictures, or None where the prefix has nothing to draw."""
    pictures = []
    for azimuth in azimuths:
        out = pathlib.Path(folder) / "view.png"
        words = [program, "render", file, "-o", out, "--quiet", "--size", f"{SIZE}x{SIZE}", "--background", "255,255,255",
                 "--azimuth", azimuth, "--max-bytes", max_bytes]
        done = subprocess.run([str(w) for w in words], stderr=subprocess.DEVNULL, check=False)
        pictures.append(matplotlib.image.imread(out)[..., :3] if done.returncode == 0 else None)
    return pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--slf", default="build/bin/slf")
    parser.add_argument("--azimuths", default="30,60", help="degrees, of the two rows")
    given = parser.parse_args()
    size = pathlib.Path(given.file).stat().st_size
    azimuths = [float(a) for a in given.azimuths.split(",")]
    figure, axes = plt.subplots(len(azimuths), len(SHARES), figsize=(2.0 * len(SHARES), 2.15 * len(azimuths)),
                                constrained_layout=True, squeeze=False)
    with tempfile.TemporaryDirectory() as folder:
        for column, share in zip(axes.T, SHARES):
            bytes_kept = round(size * share)
            for axis, picture in zip(column, views(given.slf, given.file, bytes_kept, azimuths, folder)):
                axis.set_axis_off()
                if picture is None:
                    axis.text(0.5, 0.5, "nothing", ha="center", va="center", fontsize=9)
                else:
                    axis.imshow(picture, interpolation="nearest")
            column[0].set_title(f"{share:.0%}: {bytes_kept:,} B", fontsize=9)
    figure.savefig(given.output, dpi=100)


if __name__ == "__main__":
    main()
