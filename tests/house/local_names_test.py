#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No name of an unnamed namespace stands in two source files of one folder: a unity build makes one file of them.

    local_names_test.py ROOT

Overloads compile there, and are refused too: whoever looks for a name finds one. Other names of a type (using) may be
repeated. Tests have a namespace for each file, and are left out.
"""
import collections
import pathlib
import re
import sys

from house_limits_test import code_alone, files

NOT_LOOKED_AT = {'tests', 'docs'}
UNNAMED = re.compile(r'\bnamespace\s*\{')
DEFINED = re.compile(r'\b(?:struct|class|union|enum(?:\s+class)?|concept)\s+(\w+)')
VARIABLE = re.compile(r'(?<!operator)\b(\w+)(?:\s*\[[^;]*\])?\s*$')
FUNCTION = re.compile(r'(?<![\w:~.])([A-Za-z_]\w*)\s*$')


def body_of(text, begin):
    """Text from behind a brace to the one that closes it, and of what it holds the braces alone."""
    depth, kept = 1, []
    for c in text[begin:]:
        depth += {'{': 1, '}': -1}.get(c, 0)
        if depth == 0:
            break
        if depth == 1 or (depth == 2 and c == '{'):
            kept.append(c)
    return ''.join(kept)


def without_brackets(text, left, right):
    """Text without what stands between brackets, which stay."""
    depth, kept = 0, []
    for c in text:
        depth -= c == right and depth > 0
        if depth == 0:
            kept.append(c)
        depth += c == left
    return ''.join(kept)


def names_of(declaration):
    """The names that a declaration introduces at its own level: several of "int a = 1, b = 2"."""
    declaration = re.sub(r'\[\[.*?\]\]|\balignas\s*\([^)]*\)', '', declaration)
    declaration = re.sub(r'\btemplate\s*<[^<>]*(?:<[^<>]*>[^<>]*)*>', '', declaration).strip()
    if re.match(r'(?:static_assert|using|friend|namespace|extern)\b', declaration) or 'operator' in declaration:
        return []
    defined = DEFINED.match(declaration)
    if defined:
        return [defined[1]]
    head = without_brackets(declaration, '(', ')')
    if '()' in head and '=' not in head.partition('()')[0]:
        named = FUNCTION.search(without_brackets(head.partition('()')[0], '<', '>'))
        return [named[1]] if named and ' ' in head else []
    head = without_brackets(re.sub(r'=[^,]*', '', head), '<', '>').strip()
    return [named[1] for named in map(VARIABLE.search, head.split(',')) if named and ' ' in head]


def local_names(text):
    """Names that the unnamed namespaces of a file define."""
    text = code_alone(text)
    for begin in UNNAMED.finditer(text):
        body = re.sub(r'\{\}(?=\s*[;,()<>+\-*/&|?.\]])', '', body_of(text, begin.end()))  # of values; others end something
        for declaration in re.split(r';|\{?\}', body):
            yield from names_of(declaration)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    places, count = collections.defaultdict(set), 0
    for file in files(root):
        inside = file.relative_to(root)
        if file.suffix != '.cpp' or inside.parts[0] in NOT_LOOKED_AT:
            continue
        for name in local_names(file.read_text(encoding='utf-8')):
            places[inside.parent.as_posix(), name].add(inside.name)
            count += 1
    wrong = [f'{folder}: {name} is in {", ".join(sorted(those))}' for (folder, name), those in sorted(places.items()) if len(those) > 1]
    print(*wrong, f'{count} names of one file, {len(wrong)} of them in two of a folder', sep='\n')
    sys.exit(1 if wrong or count < 1000 else 0)  # fewer: they are not found


if __name__ == '__main__':
    main()
