#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The shared library exports what its header declares and its version script lists, under that version: no more, no less.

    exported_names_test.py LIBRARY HEADER MAP
"""
import pathlib
import re
import subprocess
import sys


def exported(library):
    """Names with their versions: slf_open@@SLF_1."""
    table = subprocess.run(['nm', '-D', '--defined-only', library], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1] for line in table.splitlines() if ' A ' not in line}


def main():
    library, header, script = sys.argv[1:]
    text = pathlib.Path(script).read_text(encoding='utf-8')
    version = re.search(r'^(SLF_\d+) \{', text, re.M)[1]
    listed = set(re.findall(r'^ {4}(slf_\w+);$', text, re.M))
    code = re.sub(r'/\*(?s:.*?)\*/', '', pathlib.Path(header).read_text(encoding='utf-8'))
    declared = set(re.findall(r'^SLF_API\b[^;(]*?\b(slf_\w+)\(', code, re.M))
    there = exported(library)
    wrong = [f'{name}: not exported as {version}' for name in listed if f'{name}@@{version}' not in there]
    wrong += [f'{name}: exported, not listed' for name in there if name.split('@')[0] not in listed]
    wrong += [f'{name}: declared or listed alone' for name in declared ^ listed]
    print(*sorted(wrong), f'{len(listed)} names of {version}', sep='\n')
    sys.exit(1 if wrong or not listed else 0)


if __name__ == '__main__':
    main()
