#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Relative links of every Markdown file lead to a file and a heading; files and pages that texts and sources name are there.

    links_test.py ROOT

Headings have the anchors that GitHub gives them. A source file names a page as docs/NAME.md or docs/decisions/NNN.
A page names a file of the tree in backticks, as `codec/decoder/decode.cpp`; pages that carry a date name those of their day.
"""
import pathlib
import re
import subprocess
import sys
import urllib.parse

SOURCES = {'.cpp', '.h', '.c', '.py', '.js', '.mjs', '.ts', '.sh', '.txt', '.json', '.css', '.html', '.yml'}
NOT_OURS = {'.git', 'node_modules', '__pycache__'}
DATED = re.compile(r'docs/(?:decisions|experiments)/|CHANGELOG\.md$')
BUILT = re.compile(r'(?:^|/)(?:build|dist|made)/')  # by a program: a fresh tree has none
NAMED_FILE = re.compile(r'(?<!`)`((?:[\w.-]+/)+[\w.-]+\.(?:cpp|h|c|py|sh|js|mjs|ts|jsx|html|css|md|txt|json|cmake|map|yml))`(?!`)')


def files_of(root):
    """What git has or would add; without git every file that is not in a folder of builds."""
    listed = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True, text=True)
    if listed.returncode == 0:
        return [root / name for name in listed.stdout.splitlines() if (root / name).is_file()]
    return [p for p in root.rglob('*') if p.is_file() and not NOT_OURS & set(p.parts) and not any(q.startswith('build') for q in p.parts)]


def prose_of(text):
    """Text without code: links there are examples."""
    text = re.sub(r'^(```|~~~).*?^\1', '', text, flags=re.M | re.S)
    return re.sub(r'`[^`\n]*`', lambda code: '`' * len(code[0]), text)


def anchors_of(text):
    """The anchor of each heading as GitHub makes it: small letters, spaces to hyphens, numbered where it repeats."""
    seen, anchors = {}, set()
    for heading in re.findall(r'^#{1,6} (.*?)#*$', re.sub(r'^(```|~~~).*?^\1', '', text, flags=re.M | re.S), flags=re.M):
        plain = re.sub(r'!?\[([^\]]*)\]\([^)]*\)', r'\1', heading).strip().lower()
        slug = re.sub(r'[^\w\- ]', '', plain).replace(' ', '-')
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(slug if count == 0 else f'{slug}-{count}')
    return anchors | set(re.findall(r'<a (?:id|name)="([^"]+)"', text))


def broken_links(file, root):
    text = file.read_text(encoding='utf-8')
    for target in re.findall(r'\]\(\s*<?([^)\s>]+)>?(?:\s+"[^"]*")?\s*\)', prose_of(text)):
        if re.match(r'[a-z][a-z0-9+.-]*:', target):
            continue
        path, _, anchor = target.partition('#')
        where = (file.parent / urllib.parse.unquote(path)).resolve() if path else file.resolve()
        if not where.exists() or root.resolve() not in [where, *where.parents]:
            yield f'{file.relative_to(root)}: {target} is not there'
        elif anchor and where.suffix == '.md' and anchor not in anchors_of(where.read_text(encoding='utf-8')):
            yield f'{file.relative_to(root)}: {path or "the page"} has no heading #{anchor}'


def missing_pages(file, root):
    text = file.read_text(encoding='utf-8', errors='replace')
    for name in re.findall(r'\bdocs/[\w./-]+?\.md\b', text):
        if not (root / name).exists():
            yield f'{file.relative_to(root)}: {name} is not there'
    for number in re.findall(r'\bdocs/decisions/(\d{3})\b', text):
        if not list((root / 'docs/decisions').glob(f'{number}-*.md')):
            yield f'{file.relative_to(root)}: no decision {number}'


def missing_files(file, root):
    """Paths in backticks that begin with a folder of the tree, or of the page's own, and lead to no file."""
    name = file.relative_to(root)
    if DATED.match(name.as_posix()):
        return
    for path in NAMED_FILE.findall(file.read_text(encoding='utf-8')):
        places = [place for place in (root, root / 'include', file.parent) if (place / path.split('/')[0]).is_dir()]
        if places and not BUILT.search(path) and not any((place / path).exists() for place in places):
            yield f'{name}: {path} is not there'


def main():
    root = pathlib.Path(sys.argv[1])
    wrong, links = [], 0
    for file in files_of(root):
        if file.suffix == '.md':
            links += 1
            wrong += broken_links(file, root)
            wrong += missing_files(file, root)
        elif file.suffix in SOURCES and file.resolve() != pathlib.Path(__file__).resolve():
            wrong += missing_pages(file, root)
    print('\n'.join(sorted(wrong)) or f'{links} pages, no broken link')
    sys.exit(bool(wrong) or links == 0)


if __name__ == '__main__':
    main()
