#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figure of architecture.md: architecture.py [DIRECTORY]. Needs Python 3 alone."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "spec/figures"))
from figures import BASE, PLAIN, SLICES, Figure  # noqa: E402

DATA, NORMATIVE, FLOATING = PLAIN, BASE, SLICES[1]
WIDTH, HEIGHT, GAP = 118, 40, 20

# (words of a box, kind), left to right; what a box is made of stands below it.
ENCODE = [("capture", DATA, ""), ("mend, voxelise", FLOATING, "encoder/refine, capture"), ("observe", FLOATING, "encoder/fit"),
          ("fit view maps", FLOATING, "encoder/fit"), ("integers", DATA, "LightField"),
          ("pack", NORMATIVE, "codec/encoder"), ("bytes", DATA, ".slf")]
DECODE = [("bytes", DATA, ".slf"), ("units", NORMATIVE, "bitstream"), ("geometry", NORMATIVE, "geometry, entropy"),
          ("components", NORMATIVE, "attributes, entropy"), ("integers", DATA, "LightField"),
          ("view maps", FLOATING, "lightfield"), ("pictures", DATA, "lightfield/render")]


def path(figure, y, name, boxes):
    """One way of the data through the tree."""
    figure.word(8, y - 10, name, "start", 13)
    x = 8
    for i, (word, fill, room) in enumerate(boxes):
        figure.box(x, y, WIDTH, HEIGHT, fill, word)
        figure.word(x + WIDTH / 2, y + HEIGHT + 15, room, size=10)
        if i:
            figure.line((x - GAP, y + HEIGHT / 2), (x, y + HEIGHT / 2), arrow=True)
        x += WIDTH + GAP


def main():
    figure = Figure(8 + 7 * (WIDTH + GAP), 230)
    path(figure, 30, "encode", ENCODE)
    path(figure, 130, "decode", DECODE)
    for i, (fill, word) in enumerate([(DATA, "data"), (NORMATIVE, "integers alone, in the specification"),
                                      (FLOATING, "floating point, the same for any number of threads")]):
        figure.box(8 + 300 * i, 206, 14, 14, fill)
        figure.word(28 + 300 * i, 217, word, "start", 11)
    target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    figure.write(target / "architecture.svg")


if __name__ == "__main__":
    main()
