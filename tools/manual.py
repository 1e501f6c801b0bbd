#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Man pages and bash completion from what the program says with --help.

    manual.py PROGRAM DIRECTORY

Writes slf.1, slf-VERB.1 for every verb, and slf.bash. The same bytes for the same program. A verb without texts in
manual_texts.py is an error.
"""
import pathlib
import re
import subprocess
import sys

import manual_texts

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


def heading(group):
    """A heading in words, and what the help says of the group: Views (default: ...)."""
    words, _, remark = group.partition(' (')
    remark = remark.removesuffix(')')
    words = {'Positionals': 'Arguments', 'Subcommands': 'Commands'}.get(words, words)
    return words.upper(), f'{remark[0].upper()}{remark[1:]}.' if remark and not remark.startswith('docs/') else ''


def exit_codes(help_text):
    """[(number, meaning)] and what is said after them, of the program's own help."""
    text = ' '.join(help_text[help_text.index('Exit codes:'):].split())
    listed, _, after = text.removeprefix('Exit codes: ').partition('. ')
    return re.findall(r'(\d+) (\D+?)(?:, |$)', listed), after


def paragraphs(text):
    return '\n.PP\n'.join(roff(part) for part in text.split('\n\n'))


def page(name, version, help_text, codes, others):
    summary, usage, groups, rest = parse(help_text)
    verb = name.removeprefix('slf-')
    out = [f'.TH {name.upper()} 1 "" "slf {version}" "User Commands"', '.SH NAME',
           f'{roff(name)} \\- {roff(summary.rstrip("."))}', '.SH SYNOPSIS', f'.B {roff(usage)}',
           '.SH DESCRIPTION', paragraphs(manual_texts.DESCRIPTIONS[verb])]
    before = ''
    for group, entries in groups:
        words, remark = heading(group)
        out += [f'.SH {roff(words)}'] if words != before else ['.PP'] if remark else []
        out += [roff(remark)] if remark else []
        before = words
        for names, description in entries:
            out += ['.TP', f'.B {roff(names)}', roff(description)]
    notes = rest.partition('Exit codes:')[0].strip()
    if notes:
        out += ['.SH NOTES', paragraphs(notes)]
    out.append('.SH EXIT STATUS')
    for number, meaning in codes[0]:
        out += ['.TP', f'.B {number}', roff(meaning)]
    out += ['.PP', roff(codes[1]), '.SH EXAMPLES']
    for command, what in manual_texts.EXAMPLES[verb]:
        out += ['.TP', roff(what), '.EX', roff(command), '.EE']
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
    codes = exit_codes(top)
    pages = ['slf'] + [f'slf-{verb}' for verb in verbs]
    (directory / 'slf.1').write_text(page('slf', version, top, codes, pages), encoding='utf-8')
    for verb in verbs:
        (directory / f'slf-{verb}.1').write_text(
            page(f'slf-{verb}', version, helps[verb], codes, pages), encoding='utf-8')
    (directory / 'slf.bash').write_text(completion(verbs, helps), encoding='utf-8')


if __name__ == '__main__':
    main()
