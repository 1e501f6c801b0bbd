#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which values and states the conformance streams reach, in the text decoder, spec/decoder.py.

    values.py [--part I N] [--jobs J] [NAME ...]        reads the streams, or those named
    values.py --merge FILE ...                                  of parts that --keep FILE left

Of every limit (min, max, clip, saturate, a class of magnitude) both sides have to be reached; of the tables of rates, of shares, of
the logistic, of counts and columns every entry; of the states below each (STATES). What cannot be reached, or is not, stands in
values.txt with the reason. Nothing is left in the decoder: its source is read, and changed as it is loaded.
Needs numpy. Exit code: 0 all is reached but what values.txt has, 1 not.
"""
import argparse
import ast
import collections
import json
import multiprocessing
import pathlib
import re
import sys
import types

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "spec")]
import text_agrees  # noqa: E402

SOURCE = (HERE.parent / "spec" / "decoder.py").read_text(encoding="utf-8")
EXCUSES = HERE / "values.txt"
TABLES = {"RATES": 256, "SHARES": 7, "SQUASH": 5631, "COLUMNS_X": 256, "COLUMNS_Y": 256, "COLUMNS_Z": 256, "CORNER": 8, "WINDOW_SHIFT": 8}
WHOLE_TABLES = {"RATES", "SHARES", "COLUMNS_X", "COLUMNS_Y", "COLUMNS_Z", "CORNER", "WINDOW_SHIFT"}
SIDES = {"min": ("below", "above"), "max": ("below", "above"), "clip": ("below", "within", "above"), "saturate": ("below", "within", "above"),
         "size_class": ("below", "above")}
LIMITS = (-32768, 32767)
OF_TABLES = {"saturate", "size_class", "squash"}        # what watched functions do themselves, and what is computed once

# Kinds of requests, by entries of manifests.
STATES = {
    "region, a corner odd on every axis, with levels": lambda e: e["levels"] and all(v % 2 for v in e.get("region", [0])[:3]),
    "region, a corner odd on every axis, of all levels": lambda e: not e["levels"] and all(v % 2 for v in e.get("region", [0])[:3]),
    "region of a partial light field": lambda e: "region" in e and e["partial"],
    "partial, with levels": lambda e: e["partial"] and e["levels"],
    "partial, with groups": lambda e: e["partial"] and e["groups"],
    "partial, with layers": lambda e: e["partial"] and e.get("layers"),
    "partial, with normals": lambda e: e["partial"] and "normals_sha256" in e,
    "partial, with planes of a transform": lambda e: e["partial"] and "planes_sha256" in e,
}


class Seen:
    """What was reached: sides by limit, entries by table."""

    def __init__(self):
        """Nothing as yet."""
        self.sides, self.entries = collections.Counter(), collections.defaultdict(set)

    def two(self, site, value, other):
        """A value and a limit."""
        self.sides[site, "below" if value < other else "above" if value > other else "equal"] += 1

    def within(self, site, values, low, high):
        """Values and two limits."""
        values = np.asarray(values)
        below, above = values < low, values > high
        for side, any_of in (("below", below.any()), ("above", above.any()), ("within", not (below | above).all())):
            self.sides[site, side] += bool(any_of)

    def entry(self, table, index):
        """An entry of a table."""
        self.entries[table].add(int(index))
        return index


class Watch(ast.NodeTransformer):
    """Puts a record of what is reached before every limit and subscript."""

    def __init__(self):
        """No site as yet."""
        self.sites, self.function, self.twice = {}, "", collections.Counter()

    def visit_FunctionDef(self, node):  # noqa: N802
        """The function that sites are named after."""
        before, self.function = self.function, (re.match(r"\d[\d.]*", ast.get_docstring(node) or "") or ["-"])[0] + " " + node.name.strip("_")
        self.generic_visit(node)
        self.function = before
        return node

    def site(self, node, kind):
        """Name of a site, twice the same with a number."""
        text = " ".join(ast.unparse(node).split())
        name = f"{self.function}: {text if len(text) < 90 else text[:90] + '...'}"
        self.twice[name] += 1
        name += f" #{self.twice[name]}" if self.twice[name] > 1 else ""
        self.sites[name] = kind
        return name

    def visit_Call(self, node):  # noqa: N802
        """A limit: a record of its operands, then what it was."""
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        plain = not any(isinstance(a, ast.Starred) for a in node.args) and not node.keywords and self.function
        count = {"min": 2, "max": 2, "clip": 3, "saturate": 1, "size_class": 2}.get(name)
        wanted = plain and count == len(node.args) and (name in ("clip", "saturate", "size_class") or isinstance(node.func, ast.Name))
        site = self.site(node, name) if wanted and self.function.split()[-1] not in OF_TABLES else ""
        self.generic_visit(node)
        if not site:
            return node
        return ast.copy_location(ast.Call(ast.Name("watched_" + name, ast.Load()), [ast.Constant(site), *node.args], []), node)

    def visit_Subscript(self, node):  # noqa: N802
        """A record of the entry of a table."""
        self.generic_visit(node)
        name = getattr(node.value, "id", "")
        if name in TABLES and self.function and isinstance(node.ctx, ast.Load) and not isinstance(node.slice, ast.Slice):
            node.slice = ast.copy_location(ast.Call(ast.Name("watched_entry", ast.Load()), [ast.Constant(name), node.slice], []), node)
        return node


def watched_decoder():
    """The decoder with records, what it records in, and the sites of limits by kind."""
    seen, watch, module = Seen(), Watch(), types.ModuleType("decoder")
    tree = ast.fix_missing_locations(watch.visit(ast.parse(SOURCE)))

    def two(choice):
        """min or max."""
        def chosen(site, value, other):
            seen.two(site, value, other)
            return choice(value, other)
        return chosen

    def clip(site, values, low, high):
        seen.within(site, values, low, high)
        return np.clip(values, low, high)

    def saturate(site, value):
        side = "below" if value < LIMITS[0] else "above" if value > LIMITS[1] else "within"
        seen.sides[site, side] += 1
        return module.saturate(value)

    def size_class(site, value, most):
        unlimited = module.size_class(value, 1 << 30)
        seen.sides[site, "above" if unlimited > most else "below"] += 1
        return min(unlimited, most)

    module.__dict__.update(watched_min=two(min), watched_max=two(max), watched_clip=clip, watched_saturate=saturate,
                           watched_size_class=size_class, watched_entry=seen.entry)
    exec(compile(tree, "decoder.py", "exec"), module.__dict__)  # noqa: S102
    watch_state(module, seen)
    return module, seen, watch.sites


def watch_state(module, seen):
    """Counts of nodes behind the thresholds, states of mixed contexts, and slices that start from them."""
    decode_level, start_state, decide_mixed = module.Octree.decode_level, module.LightField.start_state, module.decide_mixed

    def level(self, decoder):
        decode_level(self, decoder)
        seen.entries["nodes coded, in 8192"].add(min(self.state.nodes_coded >> 13, 5))

    def start(self, part, kind, new):
        state = start_state(self, part, kind, new)
        if part.number and self.slices.shared and kind[0] == module.GEOMETRY:
            seen.entries["nodes a shared slice starts with, in 8192"].add(min(state.nodes_coded >> 13, 1))
        return state

    def mixed(decoder, contexts, weights, rate, more=(), behind=()):
        for table, i in contexts:
            if isinstance(table.contexts[i], tuple):
                seen.entries["counts of a mixed context"].add(table.contexts[i][0] * 15 + table.contexts[i][1])
        return decide_mixed(decoder, contexts, weights, rate, more, behind)

    module.Octree.decode_level, module.LightField.start_state, module.decide_mixed = level, start, mixed


def read(folder):
    """What a stream reaches; whether it was as its manifest says."""
    SEEN.sides.clear()
    SEEN.entries.clear()
    problems = text_agrees.check(folder)[1]
    expect = json.loads((folder / "case.json").read_text(encoding="utf-8")).get("expect", [])
    states = {name for name, holds in STATES.items() if any(holds(e) for e in expect)}
    return folder.name, problems, {f"{site}|{side}" for (site, side), n in SEEN.sides.items() if n}, dict(SEEN.entries), states


def unreached(sides, entries, states, sites):
    """Everything that has to be reached and is not, as lines."""
    for site, kind in sites.items():
        for side in SIDES[kind]:
            equal = f"{site}|equal" in sides and kind in ("min", "max") and side == "above"     # the limit itself was there
            if f"{site}|{side}" not in sides and not equal:
                yield f"limit {site}: never {side}"
    for table in sorted(WHOLE_TABLES):
        if missing := set(range(TABLES[table])) - entries.get(table, set()):
            yield f"table {table}: {len(missing)} entries are not used"
    wanted = {"nodes coded, in 8192": set(range(6)), "nodes a shared slice starts with, in 8192": {0, 1},
              "counts of a mixed context": {15 * n + k for n in range(15) for k in range(n + 1)}}
    for name, values in wanted.items():
        if missing := values - entries.get(name, set()):
            yield f"state {name}: {len(missing)} of {len(values)} never"
    for name in STATES:
        if name not in states:
            yield f"state {name}: never"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--part", nargs=2, type=int, default=[0, 1], metavar=("I", "N"))
    parser.add_argument("--jobs", type=int, default=None)
    parser.add_argument("--keep", type=pathlib.Path, metavar="FILE", help="what was reached, for --merge")
    parser.add_argument("--merge", nargs="+", type=pathlib.Path, default=[], metavar="FILE")
    arguments = parser.parse_args()
    global SEEN
    text_agrees.decoder, SEEN, sites = watched_decoder()
    sides, entries, states, failed = set(), collections.defaultdict(set), set(), 0
    for file in arguments.merge:
        kept = json.loads(file.read_text(encoding="utf-8"))
        sides |= set(kept["sides"])
        states |= set(kept["states"])
        for table, used in kept["entries"].items():
            entries[table] |= set(used)
    folders = [] if arguments.merge else sorted(
        (f for f in (HERE / "streams").iterdir() if f.name != "draco" and (not arguments.names or f.name in arguments.names)),
        key=lambda f: -(f / "stream.slf").stat().st_size)[arguments.part[0]::arguments.part[1]]
    with multiprocessing.Pool(arguments.jobs) as pool:
        for name, problems, some, used, those in pool.imap_unordered(read, folders):
            failed += bool(problems)
            print(*(f"{name}: {problem}" for problem in problems[:1]), sep="\n", end="\n" if problems else "")
            sides |= some
            states |= those
            for table, values in used.items():
                entries[table] |= values
    if arguments.keep:
        arguments.keep.write_text(json.dumps({"sides": sorted(sides), "entries": {k: sorted(v) for k, v in entries.items()},
                                              "states": sorted(states)}), encoding="utf-8")
        return failed > 0
    excuses = {line.split(" = ")[0] for line in EXCUSES.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"}
    missing = list(unreached(sides, entries, states, sites))
    for line in missing:
        if line not in excuses:
            print(line)
    for line in sorted(excuses - set(missing)):
        print(f"values.txt has what is reached: {line}")
    unknown = set(missing) - excuses
    asked = sum(len(SIDES[kind]) for kind in sites.values())
    print(f"{asked} sides of {len(sites)} limits, {sum(line.startswith('limit') for line in missing)} never reached; SQUASH: {len(entries['SQUASH'])} "
          f"of {TABLES['SQUASH']} entries; {len(unknown)} gaps without a reason")
    return 1 if unknown or failed or excuses - set(missing) else 0


if __name__ == "__main__":
    sys.exit(main())
