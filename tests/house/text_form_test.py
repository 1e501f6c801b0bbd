#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pages of the specification have whole tables, headings that stand free and brackets that close.

    text_form_test.py ROOT

A table has as many cells in every row as in its heading, and its braces close; a bar that stands between spaces in running text is what is left of a
table. Brackets of a paragraph, an item, a cell and an indented formula close; a half-open interval, as [0, 1), counts as closed.
Exit code: 0 no finding, and what the check has to find in texts of its own is found; 1 otherwise.
"""
import pathlib
import re
import sys

PAIRS = {')': '(', ']': '['}
DELIMITERS = re.compile(r'^\s*\|(?:\s*:?-+:?\s*\|)+\s*$')
ROW, HEADING = re.compile(r'^\s*\|'), re.compile(r'^#{1,6} ')
ITEM = re.compile(r'^\s*(?:[*-]|\d+\.) ')
BAR = re.compile(r'(?<!\S)\|(?!\S)|\|-+\|')  # |x| and |A| are magnitudes


def without_code(line):
    """A line whose code in backticks is blank."""
    return re.sub(r'`[^`]*`', lambda code: ' ' * len(code[0]), line)


def cells(row):
    """The cells of a row of a table."""
    return re.split(r'(?<!\\)\|', row.strip())[1:-1]


def unbalanced(text):
    """What is wrong with the round and square brackets of a text, if anything."""
    text = re.sub(r'\[(?=[^\[\]()]*, [^\[\]()]*\))([^\[\]()]*)\)', r'\1', text)
    stack = []
    for c in text:
        if c in PAIRS.values():
            stack.append(c)
        elif c in PAIRS and (not stack or stack.pop() != PAIRS[c]):
            return f'"{c}" closes nothing'
    return f'"{stack[-1]}" is not closed' if stack else None


def blocks(lines):
    """Kind, number of the first line and lines of every block: code, table, heading, item or prose; of a list each item is one."""
    kind, begin, fence = None, 0, False
    for i, line in enumerate([*lines, '']):
        marks = line.strip().startswith('```')
        if fence or marks:
            now, fence = 'fence', fence != marks
        elif not line.strip():
            now = None
        elif ROW.match(line) and (kind == 'table' or i + 1 < len(lines) and DELIMITERS.match(lines[i + 1])):
            now = 'table'
        elif HEADING.match(line):
            now = 'heading'
        elif re.match(r'^ {4}', line) and kind not in ('prose', 'item', 'table'):
            now = 'code'
        else:
            now = 'item' if ITEM.match(line) or kind == 'item' else 'prose'
        if now != kind or now == 'heading' or now == 'item' and ITEM.match(line):
            if kind:
                yield kind, begin, lines[begin:i]
            begin = i
        kind = now


def of_table(begin, rows):
    """Findings in a table: rows, brackets of cells, braces of all."""
    wide, depth = len(cells(rows[0])), 0
    for number, row in enumerate(rows, begin + 1):
        if len(cells(row)) != wide:
            yield number, f'{len(cells(row))} cells in a table of {wide}'
        for cell in cells(without_code(row)):
            if wrong := unbalanced(cell):
                yield number, f'{wrong} in a cell'
        depth += row.count('{') - row.count('}')
        if depth < 0:
            yield number, '"}" closes nothing in its table'
            depth = 0
    if depth:
        yield begin + 1, '"{" is not closed in its table'


def findings(text):
    """Line and finding, of a page."""
    lines = text.splitlines()
    for kind, begin, block in blocks(lines):
        if kind == 'heading':
            if begin and lines[begin - 1].strip() or begin + 1 < len(lines) and lines[begin + 1].strip():
                yield begin + 1, 'a heading without an empty line before and behind it'
        elif kind == 'table':
            yield from of_table(begin, block)
        elif kind != 'fence':
            for number, line in enumerate(map(without_code, block), begin + 1):
                if kind != 'code' and (BAR.search(line) or ROW.match(line)):
                    yield number, 'a bar in running text: a row of a broken table?'
            if wrong := unbalanced(without_code('\n'.join(block))):
                yield begin + 1, wrong


# What the check has to find, and what not.
BROKEN = {
    'collapsed': '5. Text.\n\n| c | other | |---|---| | 0 | before |\nratio |\n',
    'row without a table': 'Text.\n\n| c | other |\n| 0 | before |\n',
    'cells': '| a | b |\n|---|---|\n| 1 | 2 | 3 |\n',
    'bar not escaped': '| a | b |\n|---|---|\n| |v| | 2 |\n',
    'brace': '| a | b |\n|---|---|\n| if (x) { | |\n| y | u(1) |\n',
    'heading before': 'Text.\n### 7.6 More\n\nText.\n',
    'heading behind': 'Text.\n\n### 7.6 More\nText.\n',
    'round': 'With sps_coefficient_coder = 3)\n',
    'open': 'A sentence (of two\nlines.\n\nAnother).\n',
    'formula': '    x = (a + b[i)\n',
}
SOUND = '''Text with |x| ≤ 1, [0, 1), `a | b` (over
two lines).

### 7.6 More

| a | b |
|---|---|
| if (x) { | |
| y \\| z | u(1) |
| } | |

* one (
  and its end)
* [two](x)

```
| drawn )
```

    x = |a| | b  # (and)
'''


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = [f'the check does not find: {name}' for name, text in BROKEN.items() if not list(findings(text))]
    wrong += [f'the check finds in a sound text: {line}: {finding}' for line, finding in findings(SOUND)]
    pages = sorted((root / 'spec').glob('*.md'))
    for page in pages:
        wrong += [f'{page.relative_to(root)}:{line}: {finding}' for line, finding in findings(page.read_text(encoding='utf-8'))]
    print('\n'.join(wrong) or f'{len(pages)} pages, no finding')
    sys.exit(bool(wrong) or not pages)


if __name__ == '__main__':
    main()
