#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Clauses and tables of the specification that comments, tests and texts cite are there.

    clauses_cited_test.py ROOT
"""
import pathlib
import re
import sys

FOLDERS = ('attributes base bindings bitstream capture codec conformance docs encoder entropy geometry include '
           'lightfield spec tests tools web').split()
ENDINGS = {'.cpp', '.h', '.c', '.py', '.sh', '.js', '.mjs', '.html', '.md'}
NOT_OURS = {'build', 'node_modules', 'streams', 'refused'}
NUMBER = r'\d+(?:\.\d+)*'
LIST = rf'{NUMBER}(?:(?:, | and | to | - |; )(?:clauses? )?{NUMBER}(?![\w^%]))*'
# "Spec 8.7.2, 8.9", "clauses 6.3 to 6.7"; but "H.265 clauses 7.3.1" are those of another text.
CITED = re.compile(rf'(?<!H\.265 )(?<!AV1 specification )\b(?:[Ss]pec|[Cc]lauses?) ({LIST})(?![\w^%])')
COMMENT = re.compile(rf'//+ ((?=[678]\.){LIST})(?=[:.,;]|$)')  # "// 8.4: one unit"
SUITE = re.compile(r'\bSpec_(\d+(?:_\d+)*)(?=\W|_[A-Z])')
DOCSTRING = re.compile(rf'^ *"""({NUMBER}(?:(?:, | - ){NUMBER})*)[:,] ')  # of spec/decoder.py
# "table 8-3", but not those of H.265.
TABLE = re.compile(r'(?<!H\.265 )\b[Tt]ables? ([789A-G]-\d+)\b')
HEADED = re.compile(r'^Table (\d+-\d+), |^([A-G]-\d+): ', re.M)  # numbers of an annex stand as "A-1: 32768 ..."
ANNEX = re.compile(r'\b(?:[Ss]pec |of )annex ([A-Z])\b')


def clauses(text):
    """Numbers of clauses and tables, and letters of annexes, that are there."""
    numbers = set(re.findall(rf'^(?:#+ |\*\*)({NUMBER})[ *.]', text, re.M))
    numbers |= {table or annex for table, annex in HEADED.findall(text)}
    return numbers | set(re.findall(r'^## Annex ([A-Z]) ', text, re.M))


def cited(line, decoder):
    """The clauses that a line cites."""
    for numbers in CITED.findall(line) + COMMENT.findall(line) + (DOCSTRING.findall(line) if decoder else []):
        yield from re.findall(NUMBER, numbers)
    yield from (number.replace('_', '.') for number in SUITE.findall(line))
    yield from TABLE.findall(line)
    yield from ANNEX.findall(line)


def files(root):
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob('*')):
            inside = file.relative_to(root)
            if file.suffix in ENDINGS and file.is_file() and not NOT_OURS & set(inside.parts):
                yield file, inside
    for file in sorted(root.glob('*.md')):
        yield file, file.name


def main():
    root = pathlib.Path(sys.argv[1])
    there = clauses((root / 'spec/slf-bitstream.md').read_text(encoding='utf-8'))
    count, wrong = 0, []
    for file, inside in files(root):
        decoder = file.name == 'decoder.py'
        for number, line in enumerate(file.read_text(encoding='utf-8', errors='replace').splitlines(), 1):
            for clause in cited(line, decoder):
                count += 1
                if clause not in there:
                    wrong.append(f'{inside}:{number}: the specification has no {clause}')
    print(*wrong, f'{count} citations, {len(wrong)} of what is not there', sep='\n')
    sys.exit(1 if wrong or count < 100 else 0)  # fewer: they are not found, or the text is not


if __name__ == '__main__':
    main()
