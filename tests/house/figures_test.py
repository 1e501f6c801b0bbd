#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Living documents quote no measured figure that docs/figures.md does not have.

    figures_test.py ROOT

A figure is a number with a unit of size (B, kB, MB, MiB, bytes ...), quality (dB), time (ms, s, seconds, minutes) or rate (bits/point), in text
or in a column of a table whose heading has the unit. It may be rounded: 34 kB quotes 33,779 B. Limits and values of options stand in
backticks or in code, and are no figures. Pages of docs/decisions and docs/experiments are dated; they are not looked at.
"""
import pathlib
import re
import sys

SIZE, QUALITY, TIME, RATE = 'size', 'quality', 'time', 'rate'
UNITS = {'B': (SIZE, 1), 'byte': (SIZE, 1), 'bytes': (SIZE, 1), 'kB': (SIZE, 1e3), 'MB': (SIZE, 1e6), 'GB': (SIZE, 1e9), 'KiB': (SIZE, 2**10),
         'MiB': (SIZE, 2**20), 'GiB': (SIZE, 2**30), 'dB': (QUALITY, 1), 'ms': (TIME, 1e-3), 's': (TIME, 1), 'seconds': (TIME, 1), 'second': (TIME, 1),
         'minutes': (TIME, 60), 'hours': (TIME, 3600), 'bits/point': (RATE, 1), 'bits per point': (RATE, 1), 'bits a point': (RATE, 1)}
UNIT = '|'.join(sorted(UNITS, key=len, reverse=True))
NUMBER = r'\d+(?:,\d{3})+(?:\.\d+)?|\d+(?:\.\d+)?'
# Pages of figures of their own, which a program wrote with its commit or that carry a date.
OWN = {'figures.md': 'the page itself', 'related-codecs.md': 'measured by tools/rd, with date and commit'}
PATTERNS = ['README.md', 'CONTRIBUTING.md', 'docs/*.md', 'bindings/python/README.md', 'web/README.md', 'web/viewer/README.md', 'conformance/README.md']


def value_of(number, unit):
    """Kind, value and half of the last digit, in units of the kind."""
    kind, scale = UNITS[unit]
    plain = number.replace(',', '')
    decimals = len(plain.partition('.')[2])
    return kind, float(plain) * scale, 0.5 * 10**-decimals * scale


def without_code(text):
    text = re.sub(r'^(```|~~~).*?^\1', lambda code: re.sub(r'[^\n]', ' ', code[0]), text, flags=re.M | re.S)
    text = re.sub(r'`[^`\n]*`', lambda code: ' ' * len(code[0]), text)
    return '\n'.join('' if re.match(r' {4}(?! *[*-] )\S', line) and not line.lstrip().startswith('|') else line for line in text.split('\n'))


def cells(line):
    return [cell.strip() for cell in line.strip().strip('|').split('|')]


def of_text(line):
    """Every number that a unit follows; of "27.9 / 31.5 dB" and "26 to 35 ms" both."""
    for found in re.finditer(rf'(?<![\w.,/-])((?:(?:{NUMBER})(?:\s*(?:/|,|to|and|or|;|–)\s*))*(?:{NUMBER}))\s?(?:{UNIT})(?![\w/])', line):
        unit = re.search(rf'({UNIT})$', found[0])[1]
        for number in re.findall(NUMBER, found[1]):
            yield number, unit


def figures_of(text):
    """(line, number, unit) of every figure of a page."""
    heading, previous = [], ''
    for at, line in enumerate(without_code(text).split('\n'), 1):
        if not line.startswith('|'):
            heading = []
        elif re.fullmatch(r'\|(?:\s*:?-+:?\s*\|)+', line):
            heading = [(re.search(rf'(?:^|[\s,(])({UNIT})\)?$', cell) or [None, None])[1] for cell in cells(previous)]
        elif heading:
            for unit, cell in zip(heading, cells(line)):
                numbers = re.fullmatch(rf'[*\s]*({NUMBER})[*\s]*', cell)
                if unit and numbers:
                    yield at, numbers[1], unit
        for number, unit in of_text(line):
            yield at, number, unit
        previous = line


def is_known(figure, known):
    kind, value, half = figure
    return any(k == kind and abs(v - value) <= half + h + 1e-9 * abs(v) for k, v, h in known)


def main():
    root = pathlib.Path(sys.argv[1])
    known = [value_of(number, unit) for _, number, unit in figures_of((root / 'docs/figures.md').read_text(encoding='utf-8'))]
    pages = sorted({page for pattern in PATTERNS for page in root.glob(pattern)})
    wrong, checked = [], 0
    for page in pages:
        name = page.relative_to(root).as_posix()
        if page.name in OWN:
            continue
        for at, number, unit in figures_of(page.read_text(encoding='utf-8')):
            checked += 1
            if not is_known(value_of(number, unit), known):
                wrong.append(f'{name}:{at}: {number} {unit} is not a figure of docs/figures.md')
    print('\n'.join(wrong) or f'{len(pages)} pages, {checked} figures, all of {len(known)} of docs/figures.md')
    sys.exit(bool(wrong) or not known)


if __name__ == '__main__':
    main()
