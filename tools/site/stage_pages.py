#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Copies every Markdown page of the repository, and the files that pages link to, into a folder for mkdocs.

    stage_pages.py ROOT FOLDER [PROGRAM]

The tree stays as it is, so that relative links hold. A link to a folder leads to its README, or loses its address where there is none.
reference/python.md and reference/javascript.md have the docstrings and types (reference_pages.py), reference/program.md has the help of every
verb of PROGRAM, gallery/README.md the live pages that tools/site/gallery.sh made.
"""
import pathlib
import re
import shutil
import subprocess
import sys

import reference_pages


def pages_of(root):
    listed = subprocess.run(['git', '-C', str(root), 'ls-files', '*.md'], capture_output=True, text=True, check=True).stdout.splitlines()
    return [root / name for name in listed]


def help_of(program, *verb):
    return subprocess.run([program, *verb, '--help'], capture_output=True, text=True, check=True).stdout.rstrip()


def reference_of(program):
    """The help of the program and of its verbs, as a page."""
    if not program.exists():
        return '# The options of `slf`\n\n`tools/site.sh` was run without the program: build it first.\n'
    whole = help_of(program)
    verbs = re.findall(r'^  (\w+) {2,}', whole.partition('Subcommands:')[2], flags=re.M)
    parts = ['# The options of `slf`', f'```\n{whole}\n```']
    for verb in verbs:
        parts += [f'## slf {verb}', f'```\n{help_of(program, verb)}\n```']
    return '\n\n'.join(parts) + '\n'


def stage_gallery(made, folder):
    """The page of the gallery, and what it shows."""
    folder.mkdir()
    listed = made / 'list.md'
    text = listed.read_text(encoding='utf-8') if listed.exists() else '`tools/site/gallery.sh` was not run.\n'
    (folder / 'README.md').write_text('# Gallery\n\nA picture leads to its live page: turn it by hand.\n\n' + text, encoding='utf-8')
    for file in [*made.glob('*.html'), *made.glob('*.png')]:
        shutil.copyfile(file, folder / file.name)


def main():
    root, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    pages = pages_of(root)
    linked = set()

    def mended(found, page):
        """The link as it has to be in the staged page."""
        image, text, target = found[1], found[2], found[3]
        if re.match(r'[a-z][a-z0-9+.-]*:|#', target):
            return found[0]
        where = (page.parent / target.partition('#')[0]).resolve()
        if where.is_dir():
            return f'[{text}]({target.rstrip("/")}/README.md)' if (where / 'README.md').exists() else text
        linked.add(where)
        return f'{image}[{text}]({target})'

    for page in pages:
        text = re.sub(r'(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)', lambda found: mended(found, page), page.read_text(encoding='utf-8'))
        out = folder / page.relative_to(root)
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text, encoding='utf-8')
    for file in linked - set(pages):
        out = folder / file.relative_to(root)
        out.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, out)
    program = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else root / 'build/bin/slf'
    stage_gallery(root / 'build/gallery', folder / 'gallery')
    (folder / 'reference').mkdir()
    (folder / 'reference/python.md').write_text(reference_pages.python_page(root), encoding='utf-8')
    (folder / 'reference/javascript.md').write_text(reference_pages.javascript_page(root), encoding='utf-8')
    (folder / 'reference/program.md').write_text(reference_of(program), encoding='utf-8')


if __name__ == '__main__':
    main()
