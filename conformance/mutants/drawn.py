#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Misreadings drawn at random: what changes an ordinary file, the conformance streams have to notice.

    drawn.py --slf build/bin/slf [--seed S] [--number N] [--part I N] [--jobs J] [--each SECONDS] [--list] [--files FOLDER]

Edits of the text decoder, spec/decoder.py, are drawn over the clauses: a comparison flipped, a number or a shift one off, an
operation replaced, operands swapped, a limit left out, a statement left out, an entry of a table changed. Each decodes eleven ordinary files
of `slf encode` and `slf pack`, some in part. One that gives something else there, and that no stream of the suite notices, survives;
survivors are printed, as lines for survivors.txt, which has those that are known with the reason why they stay.
Needs numpy. Exit code: 0 no survivor but those known, 1 some, 2 usage.
"""
import argparse
import ast
import collections
import hashlib
import multiprocessing
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile

import run as listed
from ordinary import ordinary_files

HERE = pathlib.Path(__file__).resolve().parent
KNOWN = HERE / "survivors.txt"
OPERATORS = {ast.Add: "-", ast.Sub: "+", ast.BitAnd: "|", ast.BitOr: "&", ast.BitXor: "|", ast.LShift: ">>", ast.RShift: "<<",
             ast.Mult: "+", ast.FloorDiv: ">>", ast.Mod: "//"}
COMPARISONS = {ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "=="}
LIMITS = {"min", "max", "saturate", "clip", "clamp31", "size_class"}
# What makes no integers: the command, the words of the header, and what a stream may be (checks.txt has its checks).
NOT_DRAWN = {"main", "write", "description", "header_of", "require", "checked", "check_index", "check_boxes", "check_metadata",
             "check_end", "load"}

AS_READ = {"squash", "stretch_table", "window_bit", "window_table", "around", "corner_directions", "columns_table", "probability", "moved"}


class Drawn:
    """A misreading: where it is, what stands there and what takes its place."""

    def __init__(self, clause, function, line, node, kind, text):
        self.clause, self.function, self.kind, self.text = clause, function, kind, text
        self.line = line                    # of the function; 0: it is run as the decoder is read
        self.begin, self.end = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
        self.name = f"{clause} {function} {kind}: {' '.join(listed.SOURCE[self.begin:self.end].split())} -> {' '.join(text.split())}"
        self.left_out = 0                   # for run.by_likelihood

    def source(self):
        """The decoder with the edit."""
        return listed.SOURCE[:self.begin] + self.text + listed.SOURCE[self.end:]


LINES = [0]
for line in listed.SOURCE.encode().split(b"\n"):
    LINES.append(LINES[-1] + len(line) + 1)
assert listed.SOURCE.isascii()


def at(line, column):
    """The place of a line and column in the source."""
    return LINES[line - 1] + column


def edits_of(node):
    """Kinds of edits of an expression or statement, and what takes its place."""
    def segment(part):
        """The text of a part, as one operand."""
        return f"({ast.get_source_segment(listed.SOURCE, part)})"

    if isinstance(node, ast.Constant) and type(node.value) is int:
        yield "one-more", str(node.value + 1)
        if node.value:
            yield "one-less", str(node.value - 1)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str) and re.fullmatch(r"[\d\s]{40,}", node.value):
        entries = node.value.split()        # a table
        for i in (0, len(entries) // 2, len(entries) - 1):
            changed = entries[:i] + [str(int(entries[i]) - 1)] + entries[i + 1:]
            yield f"entry-{i}", repr(" ".join(changed))
    elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        yield "operation", f"({segment(node.left)} {OPERATORS[type(node.op)]} {segment(node.right)})"
        if isinstance(node.op, ast.Sub):
            yield "swapped", f"({segment(node.right)} - {segment(node.left)})"
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in COMPARISONS:
        yield "comparison", f"({segment(node.left)} {COMPARISONS[type(node.ops[0])]} {segment(node.comparators[0])})"
    elif isinstance(node, ast.BoolOp):
        word = " or " if isinstance(node.op, ast.And) else " and "
        yield "logic", f"({word.join(map(segment, node.values))})"
    elif isinstance(node, ast.Call) and node.args:
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name in LIMITS and not isinstance(node.args[0], (ast.GeneratorExp, ast.Starred)) and len(node.args) > (name in ("min", "max")):
            yield "no-limit", segment(node.args[0])
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield "left-out", "pass"
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub)):
        yield "sign", segment(node.operand)


def sites():
    """All misreadings that could be drawn, by clause."""
    found = collections.defaultdict(list)

    def walk(node, clause, function, line):
        """Edits in a node and in what is within it; of the clause of the function around it."""
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            docstring = ast.get_docstring(node) or ""
            clause = (re.match(r"\d+(?:\.\d+)*", docstring) or [clause])[0]
            function = node.name.strip("_")
            line = 0 if isinstance(node, ast.ClassDef) or function in AS_READ else min([node.lineno, *(d.lineno for d in node.decorator_list)])
            if function in NOT_DRAWN:
                return
        called = isinstance(node, ast.Call) and getattr(node.func, "id", "") in NOT_DRAWN
        if isinstance(node, ast.JoinedStr) or called or isinstance(node, ast.Raise):
            return
        if function or isinstance(node, (ast.Module, ast.Assign)) or clause:
            for kind, text in edits_of(node):
                found[clause].append(Drawn(clause, function or "table", line, node, kind, text))
        for child in ast.iter_child_nodes(node):
            required = isinstance(child, ast.Expr) and isinstance(child.value, ast.Call) and getattr(child.value.func, "id", "") in NOT_DRAWN
            if not required:
                walk(child, clause or ("8.4" if isinstance(node, ast.Assign) else ""), function, line)

    walk(ast.parse(listed.SOURCE), "", "", 0)
    return {clause: edits for clause, edits in found.items() if re.match("[678]", clause)}


def draw(seed, number):
    """So many misreadings: of a clause at random one at random, none twice."""
    by_clause, generator, drawn = sites(), random.Random(seed), {}
    clauses = sorted(by_clause)
    most = sum(map(len, by_clause.values()))
    while len(drawn) < min(number, most):
        mutant = generator.choice(by_clause[generator.choice(clauses)])
        drawn.setdefault((mutant.begin, mutant.end, mutant.text), mutant)
    return list(drawn.values())


def given(decoder, ordinary):
    """A digest of all that is asked of an ordinary file."""
    _, data, requests = ordinary
    digest = hashlib.sha256()
    try:
        for _, field in decoder.light_fields(data):
            for levels, groups, layers, region in requests:
                wanted = decoder.Wanted(field.sequence, levels, groups, layers)
                for array in decoder.given_out(field.sequence, field, wanted, region):
                    digest.update(array.astype("<i8").tobytes())
    except Exception as error:  # noqa: BLE001: whatever a wrong decoder does
        return f"{type(error).__name__}: {error}"
    return digest.hexdigest()


def functions_run(decoder, ordinary):
    """The first lines of the functions that an ordinary file needs."""
    lines = set()
    sys.setprofile(lambda frame, event, _: event == "call" and lines.add(frame.f_code.co_firstlineno))
    given(decoder, ordinary)
    sys.setprofile(None)
    return lines


def in_child(work, seconds):
    """What a function says in a process of its own; None where it finds no end."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        signal.setitimer(signal.ITIMER_PROF, seconds)
        sys.stderr = open(os.devnull, "w")
        try:
            said = work()
        except Exception as error:  # noqa: BLE001
            said = f"!{type(error).__name__}"
        os.write(writer, said.encode()[:4000])
        os._exit(0)
    os.close(writer)
    said = os.read(reader, 4096).decode(errors="replace")
    os.close(reader)
    os.waitpid(child, 0)
    return said or None


def judge(mutant):
    """A misreading: `same` in ordinary files, `noticed` by a stream, or `survives` with the file that shows it."""
    source = mutant.source()

    def in_ordinary():
        """The first ordinary file that it changes."""
        decoder = listed.loaded(source)
        for ordinary, expected, lines in zip(FILES, EXPECTED, RUN):
            if mutant.line in lines and given(decoder, ordinary) != expected:
                return ordinary[0]
        return "-"

    shown = in_child(in_ordinary, EACH)
    if shown == "-":
        return mutant, "same", ""
    def in_suite():
        """The first stream of the suite that notices it."""
        return listed.noticed(source, listed.by_likelihood(mutant, CASES, None))[0] or "-"

    stream = in_child(in_suite, 40 * EACH)
    return (mutant, "survives", shown or "finds no end") if stream == "-" else (mutant, "noticed", stream or "finds no end")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slf", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--number", type=int, default=300)
    parser.add_argument("--part", nargs=2, type=int, default=[0, 1], metavar=("I", "N"), help="each N-th of them from the I-th on")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--each", type=float, default=60, metavar="SECONDS", help="of a processor for the ordinary files [60]")
    parser.add_argument("--list", action="store_true", help="only what is drawn")
    parser.add_argument("--files", type=pathlib.Path, help="keep the ordinary files there")
    parser.add_argument("--verbose", action="store_true", help="a line for each")
    arguments = parser.parse_args()
    mutants = draw(arguments.seed, arguments.number)[arguments.part[0]::arguments.part[1]]
    if arguments.list:
        print(*(mutant.name for mutant in mutants), sep="\n")
        return 0
    global FILES, EXPECTED, RUN, CASES, EACH
    EACH, CASES = arguments.each, listed.all_streams(1 << 30)
    with tempfile.TemporaryDirectory() as folder:
        FILES = ordinary_files(arguments.slf, arguments.files or pathlib.Path(folder))
    right = listed.loaded(listed.SOURCE)
    EXPECTED = [given(right, ordinary) for ordinary in FILES]
    RUN = [functions_run(right, ordinary) | {0} for ordinary in FILES]
    known = {line.split(" = ")[0] for line in KNOWN.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"}
    counts, survivors = collections.Counter(), []
    with multiprocessing.Pool(arguments.jobs) as pool:
        for mutant, verdict, where in pool.imap_unordered(judge, mutants):
            counts[verdict] += 1
            if verdict == "survives" and mutant.name not in known:
                survivors.append(mutant)
            if arguments.verbose or verdict == "survives":
                print(f"{verdict}: {mutant.name} ({where})", flush=True)
    print(f"{len(mutants)} misreadings drawn with seed {arguments.seed} over {len(sites())} clauses: {counts['same']} change no ordinary file, "
          f"{counts['noticed']} are noticed, {counts['survives']} survive, {len(survivors)} of them unknown")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
