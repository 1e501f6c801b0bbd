#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Man pages and bash completion from what the program says with --help.

    manual.py PROGRAM DIRECTORY

Writes slf.1, slf-VERB.1 for every verb, and slf.bash. The same bytes for the same program.
"""
import pathlib
import re
import subprocess
import sys

INDENT = 34  # column of descriptions


def said(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def parse(text):
    """Help as (summary, usage, [(group, [(names, description)])], remaining paragraphs)."""
    lines = text.rstrip().split('\n')
    summary, usage = lines[0], lines[1].removeprefix('Usage: ')
    groups, rest = [], []
    for line, after in zip(lines[2:], [*lines[3:], '']):
        if re.match(r'\S.*:$', line) and not rest:
            groups.append((line[:-1], []))
        elif line.startswith(' ' * INDENT) and groups:
            names, description = groups[-1][1][-1]
            groups[-1][1][-1] = (names, f'{description} {line.strip()}'.strip())
        elif line.startswith('  ') and groups:
            alone = after.startswith(' ' * INDENT)  # its description is on the next line
            head, tail = (line, '') if alone else (line[:INDENT], line[INDENT:])
            groups[-1][1].append((head.strip(), tail.strip()))
        elif line or rest:
            rest.append(line)
    return summary, usage, groups, '\n'.join(rest).strip()


def roff(text):
    text = text.replace('\\', '\\e').replace('-', '\\-')
    return re.sub(r'^([.\'])', r'\\&\1', text, flags=re.M)


def page(name, version, help_text, others):
    summary, usage, groups, rest = parse(help_text)
    out = [f'.TH {name.upper()} 1 "" "slf {version}" "User Commands"', '.SH NAME',
           f'{roff(name)} \\- {roff(summary.rstrip("."))}', '.SH SYNOPSIS', f'.B {roff(usage)}']
    for group, entries in groups:
        out.append(f'.SH {roff(group.upper())}')
        for names, description in entries:
            out += ['.TP', f'.B {roff(names)}', roff(description)]
    if rest:
        out += ['.SH NOTES', roff(rest.replace('\n\n', '\n.PP\n')).replace('\n\\&.PP\n', '\n.PP\n')]
    out += ['.SH SEE ALSO', ',\n'.join(f'.BR {roff(other)} (1)' for other in others if other != name)]
    return '\n'.join(out) + '\n'


def options(help_text):
    """Long and short names of a verb's options."""
    names = []
    for _, entries in parse(help_text)[2]:
        for head, _ in entries:
            first = head.split(' ')[0]
            if first.startswith('-'):
                names += first.split(',')
    return names


def choices(help_text):
    """{option: its words}, of options that take one of a few."""
    found = {}
    for _, entries in parse(help_text)[2]:
        for head, _ in entries:
            words = re.search(r' :?\{([\w,.+-]+)\}| ([\w.+-]+(?:\|[\w.+-]+)+)', head)
            if words and head.startswith('-'):
                for name in head.split(' ')[0].split(','):
                    found[name] = re.split(r'[,|]', words[1] or words[2])
    return found


def completion(verbs, helps):
    cases = '\n'.join(
        f'    {verb}) options="{" ".join(options(helps[verb]))}" ;;' for verb in verbs)
    words = '\n'.join(f'    {verb}:{name}) words="{" ".join(given)}" ;;'
                      for verb in verbs for name, given in choices(helps[verb]).items())
    return f'''# bash completion for slf. Made by tools/manual.py; do not edit.
_slf() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options words=
  if [[ $COMP_CWORD -eq 1 ]]; then
    COMPREPLY=($(compgen -W "{' '.join(verbs)} help --help --version" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}
    *) return ;;
  esac
  case ${{COMP_WORDS[1]}}:$before in
{words}
  esac
  if [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  else
    compopt -o filenames 2>/dev/null
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}}
complete -F _slf slf
'''


def main():
    program, directory = sys.argv[1], pathlib.Path(sys.argv[2])
    directory.mkdir(parents=True, exist_ok=True)
    version = said(program, '--version').split()[-1]
    top = said(program, '--help')
    verbs = [names for group, entries in parse(top)[2] if group == 'Subcommands'
             for names, _ in entries]
    helps = {verb: said(program, verb, '--help') for verb in verbs}
    pages = ['slf'] + [f'slf-{verb}' for verb in verbs]
    (directory / 'slf.1').write_text(page('slf', version, top, pages), encoding='utf-8')
    for verb in verbs:
        (directory / f'slf-{verb}.1').write_text(
            page(f'slf-{verb}', version, helps[verb], pages), encoding='utf-8')
    (directory / 'slf.bash').write_text(completion(verbs, helps), encoding='utf-8')


if __name__ == '__main__':
    main()
