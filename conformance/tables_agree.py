#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Numbers that the text, the text decoder and the code share are the same in all of them. tables_agree.py

Compares, as text: the elements of the syntax tables of clause 7 and their descriptors with bitstream/parameter_sets.h and
slice_headers.h, transform_header.h, codec/frame_header.h; unit types; table A-1; sizes of tables 8-3 and 8-6 and of those of 8.7.2; limits of clause 9;
first weights; names of errors of annex F.
Needs Python 3 alone. Exit code: 0 all agree, 1 not.
"""
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SPEC = (ROOT / "spec" / "slf-bitstream.md").read_text(encoding="utf-8")
DECODER = (ROOT / "spec" / "decoder.py").read_text(encoding="utf-8")
PROBLEMS = []


def code(name):
    """A source file, without comments."""
    return re.sub(r"//.*", "", (ROOT / name).read_text(encoding="utf-8"))


def section(begin, end):
    """The text from one heading to another."""
    return SPEC[SPEC.index(begin):SPEC.index(end)]


def agree(what, text, others):
    """Notes where two things differ that should not, and where there is nothing to compare."""
    if text != others or not text:
        if isinstance(text, list) and isinstance(others, list) and text != others[::-1]:
            text, others = [t for t in text if t not in others] or text, [o for o in others if o not in text] or others
        PROBLEMS.append(f"{what}: {text} in the text, {others} elsewhere")


def elements(table, prefix):
    """The elements of a syntax table with the kinds of their descriptors, in order."""
    found = []
    for row in re.findall(r"^\|(.*)\|$", table, re.M):
        cells = [cell.strip() for cell in row.replace("\\|", "/").split("|")]
        names = re.findall(rf"\b{prefix}\w+", re.sub(r"^if \(.*?\)(?= \w| \{)|, c < .*", "", cells[0]))
        kinds = re.findall(r"\b(ue|se|u|s|f)\(", cells[1]) if len(cells) > 1 else []
        if names and kinds:
            found += [(name, kinds[min(i, len(kinds) - 1)]) for i, name in enumerate(names)]
    return found


def visited(source, function, prefix):
    """The same of a visited function; what it calls stands in for itself in the caller of this."""
    body = re.search(rf"void {function}\(.*?\n\}}\n", source, re.S).group(0)
    calls = re.findall(rf"v\.(u|ue|se|s8|f64)\([^\"]*?\"({prefix}\w+)\"", body)
    return [(name, {"s8": "s", "f64": "f"}.get(kind, kind)) for kind, name in calls]


def check_sequence():
    """7.2."""
    sets = code("bitstream/parameter_sets.h")
    table = section("### 7.2 Sequence", "#### 7.2.1 ")
    text = dict(elements(table, "sps_"))
    coded = {}
    for function in ("sequence_parameter_set", "base_and_cut", "basis", "point_attributes", "group_layers", "plane_run"):
        coded.update(visited(sets, function, "sps_"))
    for kind in ("geometry", "coefficient"):                # level_ranges, which is given their names
        coded[f"sps_num_{kind}_ranges_minus1"], coded[f"sps_{kind}_range_end"] = "ue", "u"
    agree("elements of 7.2", sorted(text.items()), sorted(coded.items()))
    order = [name for name, _ in elements(table, "sps_")]
    check_reserved(table, sets)
    for function in ("sequence_parameter_set", "basis"):
        names = list(dict(visited(sets, function, "sps_")))
        agree(f"order of 7.2, {function}", [name for name in order if name in names], names)


def check_reserved(table, sets):
    """3.4: elements with values left to later versions, in the table, the code and the text decoder."""
    rows = [row.split("|")[1:4] for row in table.splitlines() if re.search(r"\breserved\b", row)]
    text = {name for row in rows for name in re.findall(r"\bsps_\w+", re.sub(r"^ if \(.*?\)", "", row[0]))}
    agree("reserved values of 7.2", sorted(text), sorted(re.findall(r'"(sps_\w+)", [\w.]+,\s+defined\(', sets)))
    agree("reserved values of 7.2 in the text decoder", sorted(text), sorted(
        set(re.findall(r'"(sps_\w+)", Unsupported', DECODER)) - {"sps_version_major"}))


def check_slices():
    """7.3, 7.11."""
    text = [pair for pair in elements(section("### 7.3 Slices", "### 7.4 Geometry"), "slice") if pair[0] != "slice_id"]
    agree("elements of 7.3", text, visited(code("bitstream/slice_headers.h"), "slice_table", "slice"))
    text = elements(section("### 7.11 Transform", "## 8 Decoding"), "tr_")
    agree("elements of 7.11", text, visited(code("bitstream/transform_header.h"), "transform_header", "tr_"))
    headers = code("codec/frame_header.h")
    text = elements(section("| frame_unit( ) |", "Frames stand one after the other"), "frame_")
    agree("elements of 7.13", text, visited(headers, "frame_unit", "frame_") + visited(headers, "frame_motion", "frame_"))


def check_semantics():
    """Clause 7: a row of a syntax table has one element at most, and its clause, or one before, says what it means."""
    said = set()
    for clause in re.split(r"^###+ ", section("## 7 Syntax", "## 8 Decoding"), flags=re.M):
        coded, in_syntax, prose = [], False, []
        for line in clause.splitlines():
            cells = [cell.strip() for cell in line.split(" | ")]
            if not line.startswith("|"):
                prose.append(line)
                in_syntax = False
            elif re.match(r"\| \w+\( \) \| descriptor \|", line):
                in_syntax = True
            elif not in_syntax:
                said |= set(re.findall(r"\b[a-z0-9]+_\w+", cells[0]))
            elif len(cells) > 1 and re.search(r"\w\(\w+\)", cells[1]):
                names = re.findall(r"\b[a-z0-9]+_\w+", re.sub(r"^\|(?: |&emsp;)*", "", cells[0]))
                agree("elements of a row of clause 7", 1, len(names))
                coded += names
        if "\n| element | says | values |\n" not in clause:
            said |= set(re.findall(r"\b[a-z0-9]+_\w+", "\n".join(prose)))
        agree("elements of clause 7 without a meaning", "none", ", ".join(name for name in coded if name not in said) or "none")


def check_units():
    """7.1."""
    numbers, names = [re.findall(r"[^| ]+", row) for row in re.findall(
        r"^\| unit_type (\|.*)\|\n\|[-|]+\|\n\| (\|.*)\|$", SPEC, re.M)[0]]
    text = {name: int(number) for number, name in zip(numbers, names)}
    coded = {name.lower(): int(number)
             for name, number in re.findall(r"  k(\w+) = (\d+),", code("bitstream/units.h"))}
    agree("unit types", text, coded)
    third = dict(zip(("sequence", "slices", "geometry", "normals", "coefficients"), range(1, 6)))
    third.update(zip(("index", "metadata", "digest", "transform", "refinement", "frame"), range(6, 12)), filler=14, end=15)
    agree("unit types of the text decoder", text, third if "INDEX, METADATA, DIGEST, TRANSFORM, REFINEMENT, FRAME, FILLER, END = 6, 7, 8, 9, 10, 11, 14, 15"
          in DECODER and "SEQUENCE, SLICES, GEOMETRY, NORMALS, COEFFICIENTS = 1, 2, 3, 4, 5" in DECODER else None)


def check_tables():
    """Tables A-1, 8-3 and 8-6."""
    text = [int(n) for n in re.findall(r"\d+", SPEC[SPEC.index("A-1: ") + 4:SPEC.index("## Annex B")])]
    agree("A-1 of the text decoder", text,
          [int(n) for n in re.search(r'TABLE_A1 = .*?"""(.*?)"""', DECODER, re.S).group(1).split()])
    logistic = code("entropy/logistic.h")
    coded = [int(n) for n in re.findall(r"\b\d{5}\b", logistic)]
    agree("A-1 of the code", text, coded[coded.index(32768):][:len(text)])
    sizes = [w for w in re.findall(r"^\| [0-4] \| (\w+) \|", section("Table 8-3", "#### 8.4.3 "), re.M)]
    shapes = dict(re.findall(r"using (Faces|Corner) = ContextShape<([\d, ]+)>", code("geometry/occupancy_states.h")))
    coded = [str(math.prod(map(int, shape.split(","))).bit_length() - 1) for shape in shapes.values()]
    agree("table 8-3 of the code", [size for size in sizes if size.isdigit()], coded)
    agree("table 8-3 of the text decoder", sizes, re.sub(r"self\.hash_bits", "hash", re.search(
        r"widths = \((.*?)\)", DECODER).group(1)).split(", "))
    sizes = [int(w) for w in re.findall(r"^\| [3-5] \| (\d+) \|", section("Table 8-6", "#### 8.12.4 "), re.M)]
    shapes = dict(shapes_of("geometry/occupancy_states.h"))
    agree("table 8-6 of the code", sizes, [shapes["ReferenceFaces"], shapes["ReferenceSiblings"]])
    widths = re.search(r"widths = (.*), 1 << self\.hash_bits\n", DECODER).group(1)
    agree("table 8-6 of the text decoder", sizes, [math.prod(map(int, widths.split(",")[0].split("*"))), 1 << int(widths[-2:])])
    rows = [int(n) for n in re.findall(r"^\| (\d{5}) \+ (?:i|family) \|", SPEC, re.M)]
    all_rows = shapes["CellRows"] + shapes["NeighbourRows"] + (1 << 14)
    agree("rows of 8.12.3", rows, [all_rows, all_rows + shapes["CellRows"]])


def shapes_of(name):
    """Contexts of the tables that a file of the code declares, sizes by name, in order."""
    source = code(name)
    numbers = dict(re.findall(r"\b(k\w+) = (\d+)[,;]", source))
    found = []
    for table, sizes in re.findall(r"using (\w+) = ContextShape<([^>]+)>", source):
        sizes = re.sub(r"k\w+", lambda name: numbers[name[0]], sizes).split(",")
        found.append((table, math.prod(sum(map(int, size.split("+"))) for size in sizes)))
    return found


def check_contexts():
    """What 8.7.2 says of the sizes of its tables."""
    text = section("(*Informative*: contexts of the tables", "#### 8.7.3 ")
    sizes = [int(n) for n in re.findall(r"\b\d+\b(?! times| sets)", text)]
    vector = [size for name, size in shapes_of("attributes/vector_states.h") if name != "Set"]
    magnitude = [size // 48 for name, size in shapes_of("attributes/coefficient_magnitude_model.h") if name != "Set"]
    sign = [size for name, size in shapes_of("attributes/coefficient_sign_model.h") if name != "Set"]
    agree("tables of 8.7.2", sizes, vector + magnitude + sign)


def check_limits():
    """7.2, 7.3, 9 and first weights."""
    sets = code("bitstream/sequence_parameter_set.h")
    shifts = {name: int(power) for name, power in re.findall(r"kMax(\w+) = 1u << (\d+)", sets)}
    shifts["BasePoints"] = int(re.search(r"kMostBaseWeight = std::uint64_t\{1\} << (\d+)", code("geometry/weight_classes.h"))[1])
    lattice = int(re.search(r"4096 functions, 2\^(\d+) points of a lattice", SPEC)[1])
    agree("points of a lattice", lattice, int(re.search(r"kMostLattice = 1 << (\d+)", code("codec/frame_header.h"))[1]))
    points, slices, cells, weight = map(int, re.search(
        r"at most 2\^(\d+) points a slice, 2\^(\d+) slices, 2\^(\d+) base cells that weigh 2\^(\d+) together", SPEC).groups())
    agree("limits of 9", {"SlicePoints": points, "Slices": slices, "Cells": cells, "BasePoints": weight}, shifts)
    rows = re.findall(r"^\| (?:rows|values|bytes|points a second) .*\| 2\^(\d+) \| 2\^(\d+) \|", section("Table 9-1", "## Annex A"), re.M)
    levels = [[f"1u << {power}" for power in level] for level in zip(*rows)]
    defaults = [1 << int(re.search(rf"{name} = std::uint64_t\{{1\}} << (\d+);", code("include/slf/limits.h"))[1])
                for name in ("max_values_per_byte", "kFreeValues")]
    told = re.search(r"at most ([\d,]+) values a byte beyond the first ([\d,]+)", (ROOT / "SECURITY.md").read_text(encoding="utf-8"))
    agree("limits of SECURITY.md", [int(number.replace(",", "")) for number in told.groups()], defaults)
    agree("table 9-1", levels, [re.findall(r"1u << \d+", line) for line in re.findall(r"^    \{1u.*\}", code("bitstream/level.h"), re.M)])
    agree("table 9-1 of the text decoder", [[power.replace("1u", "1") for power in level] for level in levels],
          [re.findall(r"1 << \d+", level) for level in re.search(r"LEVELS = .*?\* 4, \((.*?)\), \((.*?)\)\)", DECODER).groups()])
    version = re.search(r"Version \*\*(\d+)\.(\d+)\*\*", SPEC).groups()
    agree("version", version, re.search(r"kVersionMajor = (\d+), kVersionMinor = (\d+)", sets).groups())
    major = re.search(r"^\| sps_version_major \|[^|]*\| (\d+); another is unsupported", SPEC, re.M).group(1)
    agree("major version", major, version[0])
    agree("major version of the text decoder", major, re.search(r'== (\d+), "sps_version_major", Unsupported', DECODER).group(1))
    agree("bytes of an extension", int(re.search(r"^\| sps_extension \|[^|]*\| 2\^(\d+) bytes", SPEC, re.M)[1]),
          int(re.search(r"kMostExtensionBytes = 1 << (\d+)", code("bitstream/parameter_sets.cpp"))[1]))
    first = re.search(r"the\s+weights\s+of\s+the\s+N\s+contexts\s+are ⌊(\d+) / N⌋,\s+the\s+others\s+0\.", SPEC).group(1)
    agree("first weights of 8.3.5", first, re.search(r"Mixer\(\[(\d+) // n\] \* n \+ \[0\]", DECODER).group(1))
    agree("first weights of 8.3.5 in the code", True, first in "".join(map(code, ("entropy/mixed_bit.h", "entropy/context_bit.h"))))
    first = re.findall(r"(?:Three|Two)\s+families\s+of\s+sets,\s+all\s+weights\s+(?:of the first two\s+)?(\d+)\s+at\s+first", SPEC)
    agree("first weights of 8.4.2 and 8.4.6", first, re.findall(r"\[Mixer\(\[(\d+)\] \* 8\) for", DECODER))
    constants = [re.search(rf"{letter} = (0x\w{{16}})", section("#### 8.4.4 ", "### 8.5 ")).group(1) for letter in "AB"]
    agree("constants of 8.4.4", constants, re.findall(r"0x\w{16}", re.search("HASH_A, HASH_B = .*", DECODER).group(0)))
    coded = code("geometry/occupancy_model.h")
    agree("constants of 8.4.4 in the code", [c.lower() for c in constants],
          [c.lower() for c in constants if c.lower() in coded.lower()])


def check_words():
    """No sentence names a file of the code or an option of a command."""
    found = re.findall(r"\b[\w/]+\.(?:cpp|h|py|json)\b|(?<!\w)--[a-z]\w+", re.sub(r"<!--.*?-->", "", SPEC))
    if found:
        PROBLEMS.append(f"the text names {found}")


def check_errors():
    """Elements that errors of streams name are in the text; those of H.265 alone need not be."""
    damage = "NotSlf|Truncated|Checksum|OutOfRange|Reserved|Unsupported"
    named = set()
    for folder in ("bitstream", "entropy", "geometry", "attributes", "attributes/texture", "attributes/video", "codec", "codec/decoder",
                   "codec/encoder", "codec/stream"):
        for path in sorted((ROOT / folder).glob("*.*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            source = code(path.relative_to(ROOT))
            found = re.findall(rf'Errc::k(?:{damage}),\s*"(\w+)"|(?:finish|trailing_bits|align_and_rest)\("(\w+)"', source)
            names = {name for pair in found for name in pair if name}
            named |= {name for name in names if folder != "attributes/video" or name.startswith("hevc_")}
    text = section("## 7 Syntax", "## 8 Decoding") + section("## Annex F", "## Annex G")
    agree("names of errors", sorted(named), sorted(name for name in named if re.search(rf"\b{name}\b", text)))


for check in (check_sequence, check_slices, check_semantics, check_units, check_tables, check_contexts, check_limits, check_errors, check_words):
    check()
for problem in PROBLEMS:
    print(problem, file=sys.stderr)
print("text, text decoder and code agree" if not PROBLEMS else f"{len(PROBLEMS)} disagree")
sys.exit(1 if PROBLEMS else 0)
