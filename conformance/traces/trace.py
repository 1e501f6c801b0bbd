#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Traces of small streams: what a decoder has after every stage, to find where another first differs.

    trace.py                   checks that the traces beside this script are current
    trace.py --write           writes them
    trace.py STREAM.slf [--decisions N] [--rows N]    prints the trace of a stream

A trace is what the text decoder, spec/decoder.py, does: of every unit the first decisions, and the first of every kind, with range, code and probability before
them, what selected their contexts, and what the unit gave; the transform tree; quantised vectors; the values of the rows after
every level; what is given out. Numbers are decimal but range and code. Needs numpy. Exit code: 0, 1: a trace is not current.
"""
import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "spec"))
import decoder as text  # noqa: E402

STREAMS = """two-points small-noise fewest-contexts small-vector large-means deep-grid transforms-apart normals-alone
cell-rows-clamped beginning-16 small-flat lone-children layers-of-runs apart-prefix-20""".split()
SHORTER = {"deep-grid": (4, 4), "beginning-16": (8, 6), "apart-prefix-20": (8, 6)}      # decisions of a unit and rows; others (12, 8)
OF_A_KIND = 3                                                   # of every kind of a unit's decisions, be they late
NAMES = {text.GEOMETRY: "geometry", text.NORMALS: "normals", text.COEFFICIENTS: "coefficients",
         text.REFINEMENT: "refinement"}


def part_name(part):
    """8.2: the base or a slice."""
    return "the base" if part.is_base else f"slice {part.number}"


class Trace:
    """Lines of a trace; in place of some functions of the text decoder, which it calls."""

    def __init__(self, decisions, rows):
        self.most, self.rows, self.lines = decisions, rows, []
        self.about, self.count, self.seen = "", 0, {}

    def say(self, line):
        if line:
            self.lines.append(line.rstrip())

    def wrap(self, owner, name, after=None, before=None):
        """`before` is called with the arguments of the function owner.name, `after` with what it gave and them."""
        inner = getattr(owner, name)

        def outer(*arguments):
            if before:
                before(*arguments)
            result = inner(*arguments)
            if after:
                after(result, *arguments)
            return result
        setattr(owner, name, outer)
        return lambda: setattr(owner, name, inner)

    def few(self, items, most=None):
        """The first items of a list, in words."""
        items, most = list(items), most or self.rows
        return "; ".join(str(item) for item in items[:most]) + (f"; ... {len(items)} in all" if len(items) > most else "")

    # what the functions of the text decoder are wrapped in

    def begin_unit(self, part, kind):
        numbers = "".join(f", {name} {number}" for name, number in zip(("level range", "group", "layer"), kind[1:]))
        self.say(f"\n{NAMES[kind[0]]} of {part_name(part)}{numbers}")
        self.count, self.seen = 0, {}

    def modes_read(self, _result, field, part, kind, _reader):
        modes = [mode for (group, _), mode in sorted(part.modes.items()) if group == kind[2]]
        self.say(f"  cu_prediction of the group so far: {modes}" if modes else "")

    def before_decision(self, decoder, p):
        self.state = decoder.range, decoder.code

    def after_decision(self, bit, _decoder, p):
        self.count += 1
        kind = self.about.split(":")[0] if "set " in self.about else "" if "child" in self.about else "prefix"
        if kind == "magnitude":
            kind += str(int(self.about.split()[-1]) // 16 % 3)          # its channel
        self.seen[kind] = self.seen.get(kind, 0) + 1
        if self.count <= self.most or kind and self.seen[kind] <= OF_A_KIND:
            self.say(f"  {self.count:4} {p:5} {self.state[0]:08x} {self.state[1]:08x} {bit}  {self.about}")
        self.about = ""

    def rows_selected(self, result, _octree, node, *_):
        rows, slow = result
        if self.count < self.most:
            self.say(f"  rows (8.4.7) of node {node}: {rows[:slow]}, then {rows[slow:]}")

    def rows_added(self, result, _rows, _selected):
        if self.count < self.most:
            self.say(f"  values of the rows: {result}")

    def predicted(self, result, octree, c, coded, around_node, columns, by_rows):
        neighbours, occupied, unknown = around_node
        indices, sets = result
        self.about = (f"level {octree.level} child {c}: neighbours {neighbours:07x} occupied {occupied:x} unknown {unknown:x} "
                      f"columns {columns} rows {by_rows}: contexts {indices} sets {sets}")

    def predicted_only(self, result, octree, _around_node, latest, beside):
        first, sets = result
        self.about = (f"level {octree.level} only child: latest {latest} beside {beside}: contexts {first} + place, sets {sets(0)} "
                      "at place 0")

    def level_decoded(self, _result, octree, _decoder):
        self.say(f"  nodes of level {octree.level}: " + self.few(octree.nodes))

    def mixed(self, decision, _decoder, indices, chosen, _behind=()):
        self.about = f"{getattr(decision, 'name', 'weight class')}: contexts {tuple(indices)} set {chosen}"

    def named(self, _result, state, _functions):
        for name in ("node", "more", "rest", "any", "negative"):
            getattr(state, name).name = {"more": "magnitude", "negative": "sign"}.get(name, name)

    def adaptive(self, _decoder, _contexts, index, _limit):
        self.about = f"context {index}"

    def tree_made(self, _result, part):
        tree = part.tree
        self.say(f"  tree of {part_name(part)}: row: code, split, left, end, parent, scale")
        for r in range(min(len(tree.codes), self.rows)):
            split = tree.split[r] if r else "-"
            self.say(f"    {r}: {tree.codes[r]:o} (octal), {split}, {tree.left[r]}, {tree.end[r]}, {tree.parent[r]}, "
                     f"{tree.scale[r]}")
        self.say(f"  cell rows: {self.few(part.cell_rows)}" if part.base else "")

    def coded(self, _result, part, _decoder, level_range, group, _state):
        rows = part.tree.rows(*part.sequence.coefficient_bounds[level_range:level_range + 2], part.sequence.grid_bits)
        rows = [r for r in rows if r or level_range == 0]
        self.say(f"  coding order: {self.few(rows, 3 * self.rows)}")
        vectors = [f"{r}: {part.coders[group].quantised[r]}" for r in rows if r in part.coders[group].quantised]
        self.say(f"  vectors that are not 0: {self.few(vectors)}")

    def level_inverted(self, _result, values, tree, _bits, level, modes, *_):
        self.say(f"  after level {level}, cu_prediction {sorted(set(modes))}: " + self.few(
            f"{r}: {values[r].tolist()[:9]}" for r in range(len(values))))

    def values_wanted(self, part, _wanted, _base_values):
        self.say(f"\nvalues of {part_name(part)} (8.8), rows, the first 9 planes")

    def cells_entered(self, result, *_):
        self.say("  cell rows (8.6.4): " + self.few(row.tolist()[:9] for row in result))

    def matrix_read(self, matrix, *_):
        self.say("  matrix: " + self.few(matrix.tolist()))

    def normals_read(self, normals, *_):
        self.say("  normals: " + self.few(normals.tolist(), 3 * self.rows))

    def install(self):
        """Puts the wrappers in; gives what takes them out."""
        decoder, part = text.ArithmeticDecoder, text.Part
        return [self.wrap(text.Part, "take", before=self.begin_unit),
                self.wrap(text.LightField, "read_coefficients", self.modes_read),
                self.wrap(decoder, "decide", self.after_decision, self.before_decision),
                self.wrap(decoder, "adaptive", before=self.adaptive),
                self.wrap(text.Octree, "select_rows", self.rows_selected), self.wrap(text.Rows, "logistic", self.rows_added),
                self.wrap(text.Octree, "predict", self.predicted),
                self.wrap(text.Octree, "predict_only", self.predicted_only),
                self.wrap(text.Octree, "decode_level", self.level_decoded),
                self.wrap(text.VectorState, "__init__", self.named),
                self.wrap(text.MixedDecision, "decode", before=self.mixed),
                self.wrap(part, "make_tree", self.tree_made), self.wrap(part, "decode_coefficients", self.coded),
                self.wrap(part, "values", before=self.values_wanted), self.wrap(text, "cell_values", self.cells_entered),
                self.wrap(text, "inverse_level", self.level_inverted), self.wrap(text, "decode_normals", self.normals_read)]


def trace_of(data, decisions, rows):
    """The text of the trace of a stream."""
    trace = Trace(decisions, rows)
    remove = trace.install()
    matrix = text.Transform.read_matrix
    text.Transform.read_matrix = staticmethod(lambda *arguments: traced_matrix(trace, matrix, *arguments))
    try:
        trace.say("decision: number, p, range, code before it, bit, and what selected its contexts")
        sequence, _, positions, components, normals = text.decode(data, 0, 0, 0, [])
    finally:
        text.Transform.read_matrix = staticmethod(matrix)
        for each in remove:
            each()
    trace.say("\ngiven out")
    for p in range(min(len(positions), rows)):
        normal = f" normal {normals[p].tolist()}" if sequence.normal_bits else ""
        trace.say(f"  {positions[p].tolist()}: {components[p].tolist()[:3]}{normal}")
    return "\n".join(trace.lines) + "\n"


def traced_matrix(trace, read_matrix, *arguments):
    """7.11: columns of a matrix, and the decisions of their codeword."""
    trace.say("  columns of the group")
    matrix = read_matrix(*arguments)
    trace.matrix_read(matrix)
    trace.count = 0
    return matrix


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stream", nargs="?", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--decisions", type=int, default=12, help="of each unit [12]")
    parser.add_argument("--rows", type=int, default=8, help="of each array [8]")
    arguments = parser.parse_args()
    if arguments.stream:
        print(trace_of(arguments.stream.read_bytes(), arguments.decisions, arguments.rows), end="")
        return 0
    stale = 0
    for name in STREAMS:
        made = trace_of((HERE.parent / "streams" / name / "stream.slf").read_bytes(), *SHORTER.get(name, (12, 8)))
        path = HERE / f"{name}.txt"
        if arguments.write:
            path.write_text(made, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != made:
            print(f"{path.name} is not current: trace.py --write", file=sys.stderr)
            stale += 1
    print(f"{len(STREAMS) - stale} of {len(STREAMS)} traces are current")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
