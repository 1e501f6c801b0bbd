#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of slf-bitstream.md: figures.py [DIRECTORY]. Needs Python 3 alone."""
import pathlib
import sys

BASE, SLICES, PLAIN, INK = "#c9d9ee", ["#cfe8cf", "#f6dcb5", "#ecc9d9"], "#eeeeee", "#333333"


class Figure:
    """An SVG picture, drawn with boxes, words and lines."""

    def __init__(self, width, height):
        self.size, self.parts = (width, height), []

    def box(self, x, y, width, height, fill="none", word="", dashed=False):
        """A box with a word in its middle."""
        dash = ' stroke-dasharray="4 3"' if dashed else ""
        place = f'x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="2"'
        self.parts.append(f'<rect {place} fill="{fill}" stroke="{INK}"{dash}/>')
        if word:
            self.word(x + width / 2, y + height / 2 + 4, word)

    def word(self, x, y, text, anchor="middle", size=12):
        """A line of text."""
        text = text.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" font-size="{size}">{text}</text>')

    def line(self, *points, arrow=False, dashed=False, width=1):
        """A line through points."""
        path = " ".join(f"{x:g},{y:g}" for x, y in points)
        more = ' marker-end="url(#tip)"' if arrow else ""
        more += ' stroke-dasharray="4 3"' if dashed else ""
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{INK}" stroke-width="{width}"{more}/>')

    def dot(self, x, y, fill, radius=5):
        """A node."""
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="{radius}" fill="{fill}" stroke="{INK}"/>')

    def write(self, path):
        """The picture as a file."""
        width, height = self.size
        head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        head += f'font-family="sans-serif" fill="{INK}">\n'
        tip = '<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="7" refY="3" orient="auto">'
        tip += '<path d="M0,0 L7,3 L0,6 z"/></marker></defs>\n'
        paper = f'<rect width="{width}" height="{height}" fill="white"/>\n'
        path.write_text(head + tip + paper + "\n".join(self.parts) + "\n</svg>\n", encoding="utf-8")


def units():
    """7.1: one order of units, coarse first, and what starts from what."""
    figure = Figure(1000, 230)
    lanes = [("base", 62, BASE)] + [(f"slice {s}", 102 + 36 * s, SLICES[s]) for s in range(3)]
    for name, y, _ in lanes:
        figure.word(8, y + 18, name, "start")
    x = 8
    for name in ("sequence", "index", "transforms", "slices"):
        figure.box(x, 12, 82, 26, PLAIN, name)
        x += 88
    x = 70
    for name, width in (("geometry", 66), ("coefficients", 84)):
        figure.box(x, 62, width, 26, BASE, name)
        x += width + 6
    columns = [("geo r", 3), ("geo r+1", 3), ("normals", 3), ("r, 0", 3), ("r, 1", 3), ("r+1, 0", 3), ("r+1, 1", 3)]
    first = x = x + 10
    for name, _ in columns:
        start = x
        for s, (_, y, fill) in enumerate(lanes[1:]):
            figure.box(x, y, 30, 26, fill)
            if s == 1 and name != "normals":
                figure.line((x - 1, 128), (x + 12, y), arrow=True)
            if s == 2 and name != "normals":
                figure.line((x - 31, 120), (x + 12, 120), (x + 14, y), arrow=True)
            x += 30
        figure.word((start + x) / 2, 216, name, size=11)
        x += 6
    figure.word((first + 3 * 96 + x) / 2, 228, "coefficients (level_range, plane_group)", size=10)
    figure.line((first - 10, 75), (first + 14, 75), (first + 14, 100), arrow=True)
    figure.word(first + 22, 72, "states", "start", 11)
    figure.word(first + 110, 94, "slices shared: the unit of slice 0 hands its states on", "start", 11)
    figure.word(960, 30, "stream: left to right", "end", 11)
    figure.box(x, 102, 44, 26, PLAIN, "end")
    return figure


def base():
    """8.2: one tree, cut across at level B; slices are runs of base cells."""
    figure = Figure(860, 324)
    occupied = [1, 2, 3, 4, 6, 7, 8, 9, 12, 13, 15, 16, 18, 19, 22, 23, 25, 26, 27, 31]
    cuts, depth, level_b = [0, 3, 6, 8], 5, 3
    cells = sorted({p >> depth - level_b for p in occupied})

    def place(level, cell):
        """Middle of a node."""
        return 100 + (cell + 0.5) * (740 / (1 << level)), 30 + 46 * level

    figure.box(100, 12, 740, 46 * level_b - 8, "#f0f5fb")
    for s in range(3):
        left, right = [100 + 740 * cuts[k] / 8 for k in (s, s + 1)]
        figure.box(left + 3, 46 * level_b + 10, right - left - 6, 124, SLICES[s])
        figure.word((left + right) / 2, 46 * level_b + 152, f"slice {s}")
    for level in range(depth):
        for cell in sorted({p >> depth - level - 1 for p in occupied}):
            figure.line(place(level, cell >> 1), place(level + 1, cell))
    for level in range(depth + 1):
        for cell in sorted({p >> depth - level for p in occupied}):
            figure.dot(*place(level, cell), BASE if level <= level_b else "white", 6 if level == level_b else 4)
    for level, name in ((0, "level 0"), (level_b, "level B"), (depth, "grid_bits")):
        figure.word(10, place(level, 0)[1] + 4, name, "start")
    figure.word(830, 32, "base: of the whole scene", "end")
    for i, cell in enumerate(cells):
        x, y = place(level_b, cell)
        figure.word(x + 18, y - 2, f"v{i}", size=10)
    caption = "vi, the value of row i of the base, is where the rows of base cell i begin in their slice (8.6.4)"
    figure.word(470, 316, caption, size=11)
    return figure


def around():
    """8.7.2: the rows around row r."""
    figure = Figure(900, 260)
    steps = [("A2", 200, 40), ("A1", 150, 85), ("A0", 210, 130), ("r", 160, 175)]
    for (_, x0, y0), (_, x1, y1) in zip(steps, steps[1:]):
        figure.line((x0, y0), (x1, y1))
    for name, x, y in steps:
        side = 1 if x > 180 else -1
        figure.line((x, y), (x + side * 40, y + 40), dashed=True)
        figure.dot(x, y, SLICES[0] if name == "r" else BASE, 13)
        figure.word(x, y + 4, name)
    figure.word(180, 240, "merges that join its node next, upwards", size=11)
    size, left, top = 44, 420, 70
    figure.box(left + size + 26, top - 26, size, size, BASE)
    figure.word(left + 2 * size + 14, top - 10, "A5", size=11)
    nodes = {(1, 1): ("r", SLICES[0]), (0, 1): ("A3", BASE), (1, 0): ("A4", BASE), (2, 0): ("", "white"),
             (0, 0): ("", "white")}
    for (i, j), (name, fill) in nodes.items():
        figure.box(left + i * size, top + (1 - j) * size, size, size, fill, name)
    figure.word(left - 14, top + size + 30, "y", size=11)
    figure.line((left - 8, top + 2 * size), (left - 8, top + 20), arrow=True)
    figure.line((left, top + 2 * size + 8), (left + 120, top + 2 * size + 8), arrow=True)
    figure.word(left + 130, top + 2 * size + 12, "x", size=11)
    figure.word(left + 66, 240, "nodes of the same split beside r's, A5 along z", size=11)
    for k, name in enumerate(["", "", "A6", "r", ""]):
        figure.box(640 + 40 * k, 100, 40, 30, SLICES[0] if name == "r" else BASE if name else PLAIN, name)
    figure.word(740, 90, "rows of the same split, in coding order", size=11)
    return figure


def prediction():
    """8.7.6: terms of two children, seen along z."""
    figure = Figure(760, 300)
    size = 84
    left, top = 60, 24

    def quarters(x, y, fill, word):
        """The four children of a node."""
        for a in range(2):
            for b in range(2):
                figure.box(x + a * size / 2, y + (1 - b) * size / 2, size / 2, size / 2, fill(a, b), word(a, b))

    terms = {(0, 1): (1, 0), (1, 0): (0, 1), (0, 0): (1, 1)}         # of p: nodes and their children
    for i in range(3):
        for j in range(3):
            x, y = left + i * size, top + (2 - j) * size
            if (i, j) == (1, 1):
                quarters(x, y, lambda a, b: SLICES[1] if a == b else "none", lambda a, b: "pq"[a] if a == b else "")
            elif (i, j) in terms:
                term = terms[i, j]
                quarters(x, y, lambda a, b: SLICES[0] if (a, b) == term else PLAIN,
                         lambda a, b: "p" if (a, b) == term else "")
            elif (i, j) in ((2, 1), (1, 2), (2, 2)):
                figure.box(x, y, size, size, BASE, "q")
            figure.box(x, y, size, size)
    words = ["node in the middle: its children p at side (−1, −1) and q at (+1, +1)",
             "nodes before it in Morton order have their children, corrected:",
             "terms of p are those that touch it, across two faces and an edge",
             "of later ones the node itself is known, with its mean",
             "before the level: terms of q",
             "",
             "along z the same: six terms at most, three faces and three edges;",
             "where a node before it lacks that child, the node itself is the term"]
    for k, text in enumerate(words):
        figure.word(350, 60 + 24 * k, text, "start", 12)
    return figure


def parts():
    """8.9: what is decoded of a stream for a part of it."""
    figure = Figure(960, 232)
    every, levels, none = ("coefficients",), ("levels < n", "≥ n"), ()
    panels = [("n ≤ B levels", [levels, none, none, none]), ("n > B levels", [every, levels, levels, levels]),
              ("a region that meets slice 2 alone", [every, every, none, every])]
    for p, (title, lanes) in enumerate(panels):
        left = 70 + 305 * p
        figure.word(left + 120, 20, title)
        for lane, decoded in enumerate(lanes):
            y, fill = 40 + 40 * lane, BASE if lane == 0 else SLICES[lane - 1]
            figure.box(left, y, 80, 26, fill if decoded else "none", "geometry", not decoded)
            words = decoded or every
            for k, word in enumerate(words):
                wanted = k == 0 and decoded
                width = 160 / len(words) - 4
                figure.box(left + 84 + k * (width + 4), y, width, 26, fill if wanted else "none", word, not wanted)
    for lane in range(4):
        figure.word(8, 58 + 40 * lane, f"slice {lane - 1}" if lane else "base", "start")
    figure.word(70, 214, "dashed: not decoded. Geometry of what is given out is needed whole, for weights count all points; "
                "of slice 0, where slices are shared, the states.", "start", 11)
    return figure


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent)
    for draw in (units, base, around, prediction, parts):
        draw().write(folder / f"{draw.__name__}.svg")


if __name__ == "__main__":
    main()
