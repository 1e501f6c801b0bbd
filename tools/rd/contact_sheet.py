#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error maps of several files on one sheet: contact_sheet.py -o OUT.png LABEL=MAP.png...

A map is a picture that `slf eval x.slf CAPTURE --error-map DIR` wrote: photograph, rendering, and their difference four
times as strong around grey. A row for each, its label beside it."""
import argparse

import matplotlib.image
import matplotlib.pyplot as plt

WIDTH = 9.0  # inches of three pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("maps", nargs="+", metavar="LABEL=MAP.png")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--dpi", type=int, default=80)
    given = parser.parse_args()
    rows = [entry.split("=", 1) for entry in given.maps]
    pictures = [matplotlib.image.imread(path)[..., :3] for _, path in rows]
    heights = [WIDTH * picture.shape[0] / picture.shape[1] for picture in pictures]
    figure, axes = plt.subplots(len(rows), 1, squeeze=False, figsize=(WIDTH, sum(heights) + 0.3 * len(rows)),
                                height_ratios=heights, constrained_layout=True)
    for axis, (label, _), picture in zip(axes[:, 0], rows, pictures):
        axis.imshow(picture, interpolation="antialiased")
        axis.set_axis_off()
        axis.set_title(label, fontsize=9, loc="left", pad=2)
    figure.savefig(given.output, dpi=given.dpi)


if __name__ == "__main__":
    main()
