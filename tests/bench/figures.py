#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the figures of docs/figures.md and writes that page.

    tests/bench/figures.py --build build --data ../shared/data --clouds ../shared/clouds --work build/figures -o docs/figures.md

Tables whose captures are not there are left out, and the page says so. Seconds are processor time, user and system, of all
threads, so that a busy machine changes them little. Results stay in WORK by commit: a run that was stopped goes on.
--only NAME measures one table and prints it, --stored measures nothing: the page has what is known. A whole run takes about 90 minutes
of one core.
"""
import argparse
import datetime
import pathlib
import platform
import re
import subprocess
import sys
import textwrap

import figures_tables as tables
from figures_surfaces import surfaces
from measured import Store

TABLES = {'pictures': ('Captures', tables.pictures), 'surfaces': ('Surfaces: given, mended, trained', surfaces),
          'splats': ('Gaussian splats of others', tables.splats), 'geometry': ('Geometry alone', tables.geometry),
          'speed': ('Decoding and drawing', tables.speed), 'moving': ('Clouds that move', tables.moving),
          'seeking': ('Any frame, and lost units', tables.seeking), 'pages': ('In a browser', tables.pages)}
ROOT = pathlib.Path(__file__).resolve().parents[2]


def commit():
    """The last commit that changed the code."""
    def git(*words):
        return subprocess.run(['git', '-C', str(ROOT), *words], capture_output=True, text=True, check=True).stdout.strip()
    code = ['--', ':!docs', ':!tests', ':!.ci', ':!tools/rd', ':!tools/site', ':!*.md']
    changed = git('status', '--porcelain', '--untracked-files=no', *code)
    return git('log', '-1', '--format=%h', '--abbrev=10', *code) + ('-dirty' if changed else '')


def machine():
    info = pathlib.Path('/proc/cpuinfo').read_text()
    name = re.search(r'model name\s*: (.*)', info)
    return f'{name[1] if name else platform.machine()}, {info.count("processor")} cores, Linux {platform.release()}'


def head(args, at):
    version = subprocess.run([args.build / 'bin/slf', '--version'], capture_output=True, text=True, check=True).stdout.split('\n')[0]
    return ['# Figures', '',
            f'{version}, commit {at}, {datetime.date.today().isoformat()}; {machine()}, beside other work.', '',
            '* `tests/bench/figures.py` writes this page. No other living document has a figure that is not here (`tests/house/figures_test.py`).',
            '* Seconds are processor time, user and system, of all threads. Other work in the caches and on the same cores makes them longer.',
            '* dB is PSNR of pictures: *inside* where file and photograph both show the object, *all* over all pixels (specification annex D).',
            '* *Held out* are photographs that the encoder did not see.', '* How the figures came about: [decisions](decisions/README.md).', '']


def wrapped(line):
    """A line of prose at 156 characters; tables stay."""
    if len(line) <= 160 or line.startswith('|'):
        return [line]
    return textwrap.wrap(line, 156, subsequent_indent='  ' if line.startswith('* ') else '', break_long_words=False, break_on_hyphens=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', type=pathlib.Path, default=pathlib.Path('build'))
    parser.add_argument('--data', type=pathlib.Path, default=pathlib.Path('../shared/data'))
    parser.add_argument('--clouds', type=pathlib.Path, default=pathlib.Path('../shared/clouds'))
    parser.add_argument('--work', type=pathlib.Path, default=pathlib.Path('build/figures'))
    parser.add_argument('--only', choices=list(TABLES))
    parser.add_argument('--commit', help="what BUILD was built from; default: the last commit that changed the code")
    parser.add_argument('--stored', action='store_true')
    parser.add_argument('-o', '--output', type=pathlib.Path)
    args = parser.parse_args()
    at = args.commit or commit()
    place = tables.Place(args.build, args.data, args.clouds, Store(args.work, at, args.stored))
    lines = [] if args.only else head(args, at)
    for name, (title, make) in TABLES.items():
        if args.only in (None, name):
            lines += [f'## {title}', '', *make(place), '']
    text = '\n'.join(part for line in lines for part in wrapped(line)).rstrip('\n') + '\n'
    if args.output:
        args.output.write_text(text)
    else:
        sys.stdout.write(text)


if __name__ == '__main__':
    main()
