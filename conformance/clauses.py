#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which stream exercises which clause: the table of annex G of slf-bitstream.md, made of the manifests and of the misreadings.

    clauses.py            checks that the table in the text is current, that every clause that says what a decoder does has a stream,
                          and that every element that a refused stream names is in the text
    clauses.py --write    writes the table

Needs Python 3 alone. Exit code: 0, 1: something is not so.
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
SPEC = HERE.parent / "spec" / "slf-bitstream.md"
BEGIN, END = "<!-- streams by clause -->\n", "<!-- end of streams by clause -->\n"


def manifests(part):
    """The manifests of streams/ or refused/, by name."""
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted((HERE / part).glob("*/case.json"))]


def order(clause):
    """A key that puts 8.10 behind 8.9."""
    return [int(number) for number in clause.split(".")]


def clauses_of(text):
    """The numbered clauses of 7 and 8, the finest: those that others are parts of are not listed."""
    heads = re.findall(r"^(?:#+ |\*\*)([78]\.\d+(?:\.\d+)?)([ *].*)", text, re.M)
    found = {clause for clause, rest in heads if "informative" not in rest} | {"3.3", "9"}
    return sorted((c for c in found if not any(other.startswith(c + ".") for other in found)), key=order)


def misreadings():
    """By clause: how many misreadings there are, and the streams that notice them."""
    found, clause = {}, None
    for line in (HERE / "mutants" / "mutants.txt").read_text(encoding="utf-8").splitlines():
        head = re.match(r"(\d[\d.]*) \S+: ", line)
        if head:
            clause = head.group(1)
            found.setdefault(clause, [0, set()])[0] += 1
        elif line.startswith("? "):
            found[clause][1] |= {stream.split("/")[1] for stream in line[2:].split()}
    return found


def exercising(clause, cases, noticing):
    """Names of the cases that name the clause or notice a misreading of it; if there are none, of one that it is part of."""
    exact = [case["id"] for case in cases if clause in case["clauses"] or case["id"] in noticing]
    return exact or [case["id"] for case in cases if any(clause.startswith(c + ".") for c in case["clauses"])]


def table(clauses):
    """The rows of the annex."""
    valid, refused, misread = manifests("streams"), manifests("refused"), misreadings()
    rows = ["| clause | streams | to be refused | misreadings |", "|---|---|---|---|"]
    for clause in clauses:
        number, noticing = misread.get(clause, ("", set()))
        cells = [", ".join(exercising(clause, cases, noticing)) for cases in (valid, refused)]
        rows.append(f"| {clause} | {cells[0]} | {cells[1]} | {number} |")
    return "\n".join(rows) + "\n"


def main():
    text = SPEC.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    clauses = clauses_of(text)
    made, problems = table(clauses), []
    if "--write" in sys.argv:
        SPEC.write_text(text[:begin] + made + text[end:], encoding="utf-8")
    elif text[begin:end] != made:
        problems.append("annex G is not current: clauses.py --write")
    cases = manifests("streams") + manifests("refused")
    misread = misreadings()
    problems += [f"no stream exercises {clause}" for clause in clauses
                 if not exercising(clause, cases, misread.get(clause, (0, set()))[1])]
    rest = text[:begin] + text[end:]        # without the names of streams; those of 7.6 may be of H.265
    names = set(re.findall(r"\w+", rest))
    problems += [f"refused/{case['id']}: the text has no {case['refuse']['element']}" for case in manifests("refused")
                 if "7.6" not in case["clauses"] and not set(re.findall(r"\w+", case["refuse"]["element"])) <= names]
    unknown = {c for case in cases for c in case["clauses"]} - set(clauses_of(text))
    problems += [f"a manifest names clause {c}, which the text has not" for c in sorted(unknown)
                 if not re.search(rf"^(#+ |\*\*)?{re.escape(c)}[ *]", text, re.M)]
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(clauses)} clauses, {len(cases)} streams, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
