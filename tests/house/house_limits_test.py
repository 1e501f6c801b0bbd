#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No file above 300 lines, no function above 60: long ones hold more than one thing. Every file names its licence.
No comment, no help text and no name of a test begins with "Of": it says first what it is about. No line has more than 160 characters, of code or of prose.

    house_limits_test.py ROOT

The line of the licence does not count. Lines of a function go from its name, or what stands before it, to its last brace.
A function within a function counts with it.
"""
import ast
import pathlib
import re
import sys

FILE_LINES, FUNCTION_LINES, LINE_CHARACTERS = 300, 60, 160
NOT_OURS = {'.git', 'node_modules', '__pycache__', 'made', 'dist'}
CPP, PYTHON = {'.cpp', '.h', '.c'}, {'.py'}
OTHERS = {'.sh', '.js', '.mjs', '.ts', '.jsx', '.cmake', '.css', '.html'}  # lines of files alone
PROSE = {'.md'}
LICENCE = re.compile(r'\A(?:#![^\n]*\n|<!doctype html>\n)?(?://|#|/\*|<!--) SPDX-License-Identifier: Apache-2\.0\b')

OF = re.compile(r'^[ \t]*(?:///?<?|#|\*|""")[ \t]*Of\b[^\n]*', re.M)
OF_LITERAL = re.compile(r'[^"\s]\s*("Of [^\n]*)')  # but not where it goes on with the literal before
OF_TEST = re.compile(r'\bTEST\w*\(\s*\w+,\s*(Of[A-Z]\w*)')
SAYS_HELP = re.compile(r'(?:encoder|tools)/.*\.(?:cpp|h)$')

# Lines of any length: markup, dated pages that nobody edits, the page of figures, which a program writes.
ANY_WIDTH = re.compile(r'.*\.(?:html|css)$|docs/(?:decisions|experiments)/|docs/figures\.md$')

# Why a file may be longer.
FILES = {
    'spec/decoder.py': 'one file on purpose: it is read beside the text, clause by clause',
    'include/slf/slf.h': 'the interface in C is one header: whoever binds another language reads it alone',
}
# Why a function may be longer: "file: function".
FUNCTIONS = {
    'spec/decoder.py: __init__': 'the syntax table of 7.2, element by element in its order',
}


def blank(found):
    return re.sub(r'[^\n]', ' ', found.group(0))


def code_alone(text):
    """C++ without comments, literals and preprocessor lines; what is left stands where it stood."""
    literal = r'R"(\w*)\((?s:.*?)\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    text = re.sub(rf'//[^\n]*|/\*(?s:.*?)\*/|{literal}', blank, text)
    return re.sub(r'^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', blank, text, flags=re.M)


def kind_of(head, inside):
    """What a brace opens, by the text before it and by what it stands in."""
    if inside in ('function', 'block'):
        return 'block'
    if re.search(r'\)[^()]*:(?!:)(?:.*[,:])?\s*\w+$', head, re.S) or re.search(r'\)\s*,\s*\w+$', head):
        return 'initialiser'                # of a member: a_{1}
    if re.search(r'\b(?:namespace|extern)\b', head) or re.search(r'\b(?:class|struct|union|enum)\b[^()=]*$', head):
        return 'scope'
    return 'function' if '(' in head and not re.search(r'=\s*$', head) else 'block'


def cpp_functions(text):
    """Name and lines of every function that is defined."""
    text = code_alone(text)
    stack, begin, parentheses = [], 0, 0
    for at, c in enumerate(text):
        if c in '()':
            parentheses += 1 if c == '(' else -1
        elif c == '{':
            head = text[begin:at].strip()
            inside = 'block' if parentheses else stack[-1][0] if stack else 'scope'
            kind = kind_of(head, inside)
            stack.append((kind, head, at - len(text[begin:at].lstrip()), parentheses))
            parentheses = 0
            begin = begin if kind == 'initialiser' else at + 1
        elif c == '}' and stack:
            kind, head, first, parentheses = stack.pop()
            if kind == 'function':
                yield name_of(head), text.count('\n', first, at) + 1
            begin = begin if kind == 'initialiser' else at + 1
        elif c == ';' and not parentheses:
            begin = at + 1


def name_of(head):
    """The name of a function; a test has that of its property."""
    test = re.search(r'\b(?:TEST\w*|BENCHMARK\w*)\(([^)]*)\)', head)
    if test:
        return re.sub(r'\s+', ' ', test[1]).replace(', ', '.')
    named = re.search(r'([\w:~]+|operator\S+)\s*\(', re.sub(r'\[\[.*?\]\]|\btemplate\s*<.*?>\s', '', head))
    return named[1] if named else head[:40]


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            yield node.name, node.end_lineno - node.lineno + 1


def files(root):
    """Files of the tree, without what is built or fetched in it."""
    for path in sorted(root.iterdir()):
        if path.name in NOT_OURS or (path / 'CMakeCache.txt').exists() or path.name.startswith('build'):
            continue
        if path.is_dir():
            yield from files(path)
        elif path.suffix in CPP | PYTHON | OTHERS | PROSE or path.name == 'CMakeLists.txt':
            yield path


def functions_of(file, text):
    if file.suffix in CPP:
        return list(cpp_functions(text))
    return list(python_functions(text)) if file.suffix in PYTHON else []


def genitives(name, text):
    """Place and text of every comment, name of a test, and literal of what prints help, that begins with "Of"."""
    found = [('a comment', comment.start(), comment[0].strip()) for comment in OF.finditer(text)]
    found += [('a test', test.start(1), test[1]) for test in OF_TEST.finditer(text)]
    if SAYS_HELP.match(name):
        found += [('a text', literal.start(1), literal[1]) for literal in OF_LITERAL.finditer(text)]
    for kind, at, said in found:
        yield f'{name}:{text.count(chr(10), 0, at) + 1}: {kind} begins with "Of": {said[:60]}'


def wide_lines(file, name, text):
    """Place of every line that is too wide; in prose not of tables, code and pictures, which are one line."""
    if ANY_WIDTH.match(name):
        return
    if file.suffix in PROSE:
        text = re.sub(r'^(```|~~~)(?s:.*?)^\1|^ *\|[^\n]*|^!\[[^\n]*|^ {4}(?! *[*-] )\S[^\n]*', blank, text, flags=re.M)
    for at, line in enumerate(text.split('\n'), 1):
        if len(line.rstrip()) > LINE_CHARACTERS:
            yield f'{name}:{at}: {len(line)} characters'


def findings(root, counts):
    """What is too long: by whom it is excused, and a line that says it."""
    for file in files(root):
        name, text = file.relative_to(root).as_posix(), file.read_text(encoding='utf-8')
        for said in wide_lines(file, name, text):
            yield name, {}, said
        if file.suffix in PROSE:
            continue
        if not LICENCE.match(text):
            yield name, {}, f'{name}: does not begin with its licence, as others do (SPDX-License-Identifier)'
        if text.count('\n') - 1 > FILE_LINES:
            yield name, FILES, f'{name}: {text.count(chr(10)) - 1} lines'
        for said in genitives(name, text):
            yield name, {}, said
        functions = functions_of(file, text)
        counts[file.suffix] = counts.get(file.suffix, 0) + len(functions)
        for function, lines in functions:
            if lines > FUNCTION_LINES:
                yield f'{name}: {function}', FUNCTIONS, f'{name}: {function} has {lines} lines'


def main():
    counts = {}
    found = list(findings(pathlib.Path(sys.argv[1]).resolve(), counts))
    wrong = [said for key, excused, said in found if key not in excused]
    needless = (FILES.keys() | FUNCTIONS.keys()) - {key for key, _, _ in found}
    for key in sorted(needless):            # no failure: who shortens a file need not know of this list
        print(f'{key}: is short enough, and needs no exception')
    number = sum(counts.values())
    print(*wrong, f'{len(wrong)} findings, {len(found)} with those that have a reason; {number} functions', sep='\n')
    sys.exit(1 if wrong or counts.get('.cpp', 0) < 1000 else 0)  # fewer: they are not found


if __name__ == '__main__':
    main()
