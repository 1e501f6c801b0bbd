#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Misreadings of the specification, each of which the conformance streams have to notice.

    run.py [--part I N] [--jobs J] [--record] [NAME ...]

A misreading (mutants.txt) is one edit of the text decoder, spec/decoder.py; besides those listed, every check that the decoder
makes is left out in turn. The decoder so changed decodes the streams that the list names for it, at least one of which it must
get wrong: other values, a refusal of a valid stream, none of one that is to be refused, an exception, or ten times the time.
--part checks each N-th from the I-th on. --record looks for a stream that notices each of those named, or those that have none, and
writes it into the list and into annex G.
Needs numpy. Exit code: 0 every misreading that has a stream was noticed, 1 not. Those without one are open: counted, not hidden.
"""
import argparse
import json
import multiprocessing
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import types

HERE = pathlib.Path(__file__).resolve().parent
SUITE = HERE.parent
sys.path[:0] = [str(SUITE), str(SUITE.parent / "spec")]
import text_agrees  # noqa: E402

SOURCE = (SUITE.parent / "spec" / "decoder.py").read_text(encoding="utf-8")
LIST, CHECKS = HERE / "mutants.txt", HERE / "checks.txt"
SLOWEST = 20                               # seconds of a processor for one stream


class Mutant:
    """One misreading: its name, clause and what is misread; the edits; streams that notice it, or why none can."""

    def __init__(self, clause, name, misread):
        self.clause, self.name, self.misread = clause, name, misread
        self.function, self.edits, self.streams, self.excuse = "", [], [], ""
        self.left_out = 0                   # where a check begins that is left out

    def source(self):
        """The decoder with the edits, each of which must fit one place."""
        source = SOURCE
        if self.left_out:
            return SOURCE[:self.left_out] + "True or " + SOURCE[self.left_out:]
        for old, new in self.edits:
            old, new = "\n".join(old), "\n".join(new)
            places = [at.start() for at in re.finditer(re.escape(old), source)
                      if self.function in ("", function_at(source, at.start()))]
            if len(places) != 1:
                raise SystemExit(f"{self.name}: an edit fits {len(places)} places of spec/decoder.py")
            source = source[:places[0]] + new + source[places[0] + len(old):]
        return source


def function_at(source, place):
    """The name of the function, or method, around a place."""
    names = re.findall(r"^(?:    )?def (\w+)", source[:place], re.M)
    return names[-1] if names else ""


def listed():
    """The misreadings of mutants.txt."""
    mutants = []
    for line in LIST.read_text(encoding="utf-8").splitlines():
        mark, rest = line[:2], line[2:]
        if not line.strip() or line.startswith("#"):
            continue
        if mark == "@ ":
            mutants[-1].function = rest
        elif mark == "- ":
            edits = mutants[-1].edits
            if not edits or edits[-1][1]:
                edits.append(([], []))
            edits[-1][0].append(rest)
        elif mark == "+ ":
            mutants[-1].edits[-1][1].append(rest)
        elif mark == "? ":
            mutants[-1].streams += rest.split()
        elif mark == "= ":
            mutants[-1].excuse = rest
        else:
            mutants.append(Mutant(*re.fullmatch(r"(\S+) (\S+): (.+)", line).groups()))
    names = [mutant.name for mutant in mutants]
    assert len(names) == len(set(names)), "a name stands twice"
    return mutants


def checks():
    """A misreading for every check: that it is left out."""
    counts, found = {}, []
    for at in re.finditer(r"(?<!def )\brequire\(|\bchecked\(\d, lambda v: ", SOURCE):
        words = re.findall(r'f?"([a-z_][^"]*)"', call_at(at.start()))
        if "lambda" in at.group(0) or words:
            element = re.match(r"\w*", words[-1].replace("{kind}", "x").replace("{name}", "x")).group(0)
        else:
            element = "element"
        clause = re.findall(r'"""(\d+(?:\.\d+)*)', SOURCE[:at.start()])[-1]
        name = f"{element}-in-{function_at(SOURCE, at.start()).strip('_')}"
        counts[name] = counts.get(name, 0) + 1
        name += f"-{counts[name]}" if counts[name] > 1 else ""
        mutant = Mutant(clause, "without-" + name, f"{element} is not checked")
        mutant.left_out = at.end()
        found.append(mutant)
    lines = CHECKS.read_text(encoding="utf-8").splitlines()
    known = dict(re.split(r"(?=[:=] )", line, maxsplit=1) for line in lines if line and line[0] != "#")
    for mutant in found:
        entry = known.get(mutant.name, ": ")
        if entry[0] == "=":
            mutant.excuse = entry[2:]
        else:
            mutant.streams = entry[2:].split()
    return found


def call_at(place):
    """The text of a call, to its closing parenthesis."""
    depth, end = 0, SOURCE.index("(", place)
    while True:
        depth += {"(": 1, ")": -1}.get(SOURCE[end], 0)
        end += 1
        if depth == 0:
            return SOURCE[place:end]


def loaded(source):
    """The decoder as a module, of other source."""
    module = types.ModuleType("decoder")
    exec(compile(source, "decoder.py", "exec"), module.__dict__)  # noqa: S102
    return module


def noticed(source, streams):
    """The first stream that shows something of a decoder, and what; nothing if none does."""
    module = None
    for stream in streams:
        signal.setitimer(signal.ITIMER_PROF, SLOWEST)   # which ends the process
        try:
            text_agrees.decoder = module = module or loaded(source)
            problems = text_agrees.check(SUITE / stream)[1]
        except Exception as error:  # noqa: BLE001: whatever a wrong decoder does
            problems = [f"{type(error).__name__}: {error}"]
        if problems:
            return stream, problems[0]
    return "", ""


def check(mutant):
    """A misreading, the stream that notices it, and how; found out in a process of its own, which may find no end."""
    if not mutant.streams:
        return mutant, "", ""
    source = mutant.source()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        stream, said = noticed(source, mutant.streams)
        os.write(writer, f"{stream}\n{said}".encode()[:4000])
        os._exit(0)
    os.close(writer)
    said = os.read(reader, 4096).decode(errors="replace")
    os.close(reader)
    os.waitpid(child, 0)
    stream, said = said.split("\n", 1) if said else (mutant.streams[0], "finds no end")
    return mutant, stream, said


LIKELY = "small-noise small-vector deep-scene small-independent small-alone small-scene large-means".split()     # notice most


def all_streams(most):
    """Names and cases of the streams but those of Draco, which are not decoded, the cheapest first."""
    cases = {}
    for folder in [f for part in ("streams", "refused", "refused_frames") for f in (SUITE / part).iterdir() if f.name != "draco"]:
        text = (folder / "case.json").read_text(encoding="utf-8")
        cost = (folder / "stream.slf").stat().st_size * max(1, text.count('"levels"'))     # of decoding, about
        if cost <= most:
            cases[f"{folder.parent.name}/{folder.name}"] = (cost, json.loads(text))
    return dict(sorted(cases.items(), key=lambda case: case[1][0]))


def by_likelihood(mutant, cases, tries):
    """The streams that are the most likely to notice a misreading first: of its element, of its clause, of many things."""
    def rank(stream):
        case = cases[stream][1]
        if mutant.left_out:
            return "refuse" not in case, case.get("refuse", {}).get("element", "?") not in mutant.name
        number = LIKELY.index(case["id"]) if case["id"] in LIKELY else 99
        exact = any(mutant.clause == c or mutant.clause.startswith(c + ".") for c in case["clauses"])
        return "refuse" in case, not exact and number == 99, not exact, number
    return sorted(cases, key=rank)[:tries]


def find(job):
    """A misreading and the stream that notices it, one of its own if it has one that does."""
    mutant, streams = job
    found = check(mutant)
    if not found[1]:
        known, mutant.streams = mutant.streams, streams
        found = check(mutant)
        mutant.streams = known
    return found


def record(mutants, cases, processes, tries):
    """Looks for a stream for each that has none that notices it, and writes the lists."""
    names = {mutant.name: mutant for mutant in mutants}
    jobs = [(m, by_likelihood(m, cases, tries)) for m in mutants if m.wanted]
    with multiprocessing.Pool(processes) as pool:
        try:
            for mutant, stream, said in pool.imap_unordered(find, jobs):
                print(f"{mutant.name}: {stream}: {said}", flush=True)
                names[mutant.name].streams = [stream] if stream else []
        except KeyboardInterrupt:
            pool.terminate()                # what was found is written
    write([m for m in mutants if m.edits])
    lines = [line for line in CHECKS.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    for m in mutants:
        if not m.edits:
            lines.append(m.name + (f"= {m.excuse}" if m.excuse else f": {' '.join(m.streams)}"))
    CHECKS.write_text("\n".join(lines) + "\n", encoding="utf-8")
    subprocess.run([sys.executable, HERE.parent / "clauses.py", "--write"], check=True)     # annex G names these streams


def write(mutants):
    """mutants.txt, whose beginning, a comment, stays."""
    text = re.match(r"(#.*\n|\n)*", LIST.read_text(encoding="utf-8")).group(0).rstrip("\n") + "\n"
    for m in mutants:
        text += f"\n{m.clause} {m.name}: {m.misread}\n"
        text += f"@ {m.function}\n" if m.function else ""
        for old, new in m.edits:
            text += "".join(f"- {line}\n" for line in old) + "".join(f"+ {line}\n" for line in new)
        text += f"? {' '.join(m.streams)}\n" if m.streams else f"= {m.excuse}\n" if m.excuse else ""
    LIST.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--part", nargs=2, type=int, default=[0, 1], metavar=("I", "N"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--most", type=int, default=20000, help="with --record: streams of about this cost [20000]")
    parser.add_argument("--tries", type=int, default=None, help="with --record: so many streams each [all]")
    arguments = parser.parse_args()
    mutants = listed() + checks()
    for mutant in mutants:
        mutant.wanted = mutant.name in arguments.names if arguments.names else not mutant.streams and not mutant.excuse
    if arguments.record:
        return record(mutants, all_streams(arguments.most), arguments.jobs, arguments.tries)
    chosen = [m for m in mutants if not arguments.names or m.name in arguments.names]
    chosen = chosen[arguments.part[0]::arguments.part[1]]
    excused = [m for m in chosen if m.excuse]
    still_open = [m for m in chosen if not m.excuse and not m.streams]
    chosen = [m for m in chosen if m.streams]
    for mutant in chosen:                   # here: a process of the pool that ends would be waited for
        mutant.source()
        if missing := [stream for stream in mutant.streams if not (SUITE / stream / "case.json").exists()]:
            raise SystemExit(f"{mutant.name}: there is no {missing[0]}")
    missed = 0
    with multiprocessing.Pool(arguments.jobs) as pool:
        for mutant, stream, said in pool.imap_unordered(check, chosen):
            missed += not stream
            if not stream or arguments.names:
                print(f"{mutant.name}: {f'{stream}: {said}' if stream else 'is not noticed'}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} misreadings are noticed; {len(excused)} cannot be; for {len(still_open)} no stream is known")
    sys.exit(1 if missed or not chosen else 0)


if __name__ == "__main__":
    main()
