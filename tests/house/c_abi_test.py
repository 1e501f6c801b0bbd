#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The C interface keeps what its record has: every function as declared, every constant, the place and type of every member of a struct.

    c_abi_test.py HEADER RECORD [--record]

The record is of LP64 machines. What is new may come; what is recorded may not change or go before the next major version. --record adds what is new.
"""
import pathlib
import re
import subprocess
import sys
import tempfile


def functions(code):
    """Declarations, blanks made one."""
    found = re.findall(r'^SLF_API\b([^;]*);', code, re.M)
    return {re.sub(r'\s+', ' ', text).strip() for text in found}


def structs(code):
    """Each complete struct with its members, (type, name), in order."""
    found = {}
    for name, body in re.findall(r'^typedef struct (\w+) \{(.*?)^\} \1;', code, re.M | re.S):
        found[name] = []
        for line in (re.sub(r'\s+', ' ', part).strip() for part in body.split(';')):
            pointer = re.match(r'.*\(\*(\w+)\)', line)
            if pointer:
                found[name].append((line.replace(pointer[1], '', 1), pointer[1]))
            elif line:
                kind, names = re.match(r'((?:const )?\w+ ?\**) ?(.*)', line).groups()
                found[name] += [(kind.strip() + ''.join(re.findall(r'\[\d+\]', each)), re.match(r'\s*\*?(\w+)', each)[1]) for each in names.split(',')]
    return found


def constants(code):
    listed = re.findall(r'^#define (SLF_\w+) (\d+u?)\b', code, re.M)
    named = re.findall(r'\b(SLF_\w+) = (\d+)', code)
    return {f'{name} = {value.rstrip("u")}' for name, value in listed + named if not name.startswith('SLF_API_VERSION')}


def layout(header, found):
    """What a C compiler makes of the structs."""
    lines = [f'printf("{name} starts with {members[0][1]}\\n"); ' + ''.join(
        f'printf("{name}.{member}: {kind}, bytes %zu to %zu\\n", offsetof({name}, {member}), '
        f'offsetof({name}, {member}) + sizeof((({name}*)0)->{member}));' for kind, member in members) for name, members in found.items()]
    fixed = [f'printf("{name}: %zu bytes\\n", sizeof({name}));' for name, members in found.items() if members[0][1] != 'size']
    program = f'#include "{header}"\n#include <stdio.h>\nint main(void) {{\n' + '\n'.join(lines + fixed) + '\nreturn 0;\n}\n'
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / 'layout.c'
        source.write_text(program, encoding='utf-8')
        subprocess.run(['cc', '-std=c99', source, '-o', source.with_suffix('')], check=True)
        return set(subprocess.run([source.with_suffix('')], capture_output=True, text=True, check=True).stdout.splitlines())


def main():
    header, record = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    code = re.sub(r'/\*(?s:.*?)\*/', '', header.read_text(encoding='utf-8'))
    found = structs(code)
    now = functions(code) | constants(code) | layout(header, found)
    if '--record' in sys.argv:
        kept = set(record.read_text(encoding='utf-8').splitlines()) if record.exists() else set()
        record.write_text('\n'.join(sorted(kept | now)) + '\n', encoding='utf-8')
    kept = set(record.read_text(encoding='utf-8').splitlines())
    print(*(f'changed or gone: {line}' for line in sorted(kept - now)), *(f'not recorded: {line}' for line in sorted(now - kept)),
          f'{len(kept)} lines of the interface', sep='\n')
    sys.exit(1 if kept != now or len(found) < 8 else 0)


if __name__ == '__main__':
    main()
