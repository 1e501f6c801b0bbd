# SPDX-License-Identifier: Apache-2.0
"""Reference of the Python package and of the npm package as Markdown, from docstrings and .d.ts files. Nothing is imported or fetched."""
import ast
import re

DECLARATIONS = {  # of the npm package: what a page imports, and the files that say its types
    'slf-decoder': ['web/slf.d.ts', 'web/slf_stream.d.ts', 'web/slf_frame_stream.d.ts'],
    'slf-decoder/worker': ['web/slf_worker.d.ts'],
    'slf-decoder/inline': ['web/inline.d.ts'],
    'slf-decoder/viewer/slf_viewer.js': ['web/viewer/slf_viewer.d.ts'],
    'slf-decoder/viewer/SLFLoader.js': ['web/viewer/SLFLoader.d.ts'],
    'slf-decoder/viewer/surface_light_field.js': ['web/viewer/surface_light_field.d.ts'],
}


def escaped(text):
    """Text of a comment as Markdown: what looks like markup stays as it is, code in backticks is code."""
    return re.sub(r'`[^`]*`|[\\<>\[\]*_]', lambda found: found[0] if len(found[0]) > 1 else '\\' + found[0], text)


def prose(docstring):
    """A docstring's lines as paragraphs; what is indented stays code."""
    parts = []
    for part in docstring.strip().split('\n\n'):
        parts.append(part if part.startswith('    ') else escaped(part))
    return '\n\n'.join(parts)


# Python ---------------------------------------------------------------------------------------------------------------

def signature(node):
    arguments = ast.unparse(node.args)
    arguments = re.sub(r'^(self|cls)(, )?', '', arguments)
    returns = f' -> {ast.unparse(node.returns)}' if node.returns else ''
    return f'{node.name}({arguments}){returns}'


def docstring_of(node):
    return prose(ast.get_docstring(node) or '')


def fields_of(node, lines):
    """Annotated members of a class that are no methods, with the comment `#:` behind them."""
    for member in node.body:
        if isinstance(member, ast.AnnAssign) and not member.target.id.startswith('_'):
            said = re.search(r'#: (.*)', lines[member.end_lineno - 1])
            yield ast.unparse(member).replace('dataclasses.field(repr=False)', '...'), said[1] if said else ''


def class_page(node, lines):
    out = [f'## {node.name}', docstring_of(node)]
    listed = [f'* `{text}`{": " + escaped(said) if said else ""}' for text, said in fields_of(node, lines)]
    if listed:
        out.append('\n'.join(listed))
    for member in node.body:
        if not isinstance(member, ast.FunctionDef) or member.name.startswith('_'):
            continue
        made_by = [ast.unparse(d).rpartition('.')[2] for d in member.decorator_list]
        title = member.name if {'property', 'cached_property'} & set(made_by) else signature(member)
        kind = ' (class method)' if 'classmethod' in made_by else ''
        if 'overload' not in made_by:
            out += [f'### {node.name}.{member.name}', f'`{title}`{kind}', docstring_of(member)]
    return '\n\n'.join(part for part in out if part)


def python_page(root):
    package = root / 'bindings/python/slf'
    init = ast.parse((package / '__init__.py').read_text(encoding='utf-8'))
    names = next(ast.literal_eval(node.value) for node in init.body
                 if isinstance(node, ast.Assign) and node.targets[0].id == '__all__')
    found = {}
    for file in sorted(package.glob('_*.py')):
        text = file.read_text(encoding='utf-8')
        for node in ast.parse(text).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                found[node.name] = (node, text.splitlines())
    missing = [name for name in names if name not in found and not name.startswith('__')]
    if missing:
        raise SystemExit(f'reference_pages.py: no definition of {", ".join(missing)}')
    functions, classes = [], []
    for name in sorted((name for name in names if name in found), key=str.lower):
        node, lines = found[name]
        if isinstance(node, ast.FunctionDef):
            functions.append(f'## {name}\n\n`{signature(node)}`\n\n{docstring_of(node)}')
        else:
            classes.append(class_page(node, lines))
    return '\n\n'.join(['# Python', prose(ast.get_docstring(init)), *functions, *classes]) + '\n'


# JavaScript -----------------------------------------------------------------------------------------------------------

def statements(text):
    """(comment, statement) of declarations that follow each other; a statement ends with ; or a block at depth 0."""
    at, comment, begin, depth = 0, '', None, 0
    while at < len(text):
        if depth == 0 and begin is None and text.startswith('/**', at):
            end = text.index('*/', at)
            comment = ' '.join(line.strip().lstrip('*').strip() for line in text[at + 3:end].split('\n')).strip()
            at = end + 2
        elif text.startswith('/*', at):
            at = text.index('*/', at) + 2
        elif text.startswith('//', at):
            at = text.find('\n', at) if '\n' in text[at:] else len(text)
        else:
            c = text[at]
            if begin is None and not c.isspace():
                begin = at
            depth += c in '({['
            depth -= c in ')}]'
            ends = depth == 0 and begin is not None and (c == ';' or c == '}' and re.match(r'\s*(\n|$)', text[at + 1:]))
            if ends:
                yield comment, text[begin:at + 1].strip()
                comment, begin = '', None
            at += 1


def code(text):
    """One line of a declaration, its own comments left out."""
    text = re.sub(r'/\*.*?\*/|//[^\n]*', '', text, flags=re.S)
    return '`' + re.sub(r'\s+', ' ', text).strip().rstrip(';') + '`'


def declaration(comment, text):
    text = re.sub(r'^export (declare )?', '', text)
    kind, name = re.match(r'(?:abstract )?(class|interface|type|function|const) (\w+)', text).groups()
    out = [f'### {name}', *([escaped(comment)] if comment else [])]
    if kind not in ('class', 'interface'):
        return '\n\n'.join([*out, code(text)])
    head, _, body = text.partition('{')
    out.append(code(head))
    listed = [f'* {code(member)}{": " + escaped(said) if said else ""}'
              for said, member in statements(body.rstrip().removesuffix('}')) if not member.startswith('private')]
    return '\n\n'.join([*out, '\n'.join(listed)])


def javascript_page(root):
    out = ['# JavaScript', 'What the package `slf-decoder` exports, by the module that a page imports it from.']
    for module, files in DECLARATIONS.items():
        out.append(f'## {module}')
        for file in files:
            text = (root / file).read_text(encoding='utf-8')
            out += [declaration(comment, statement) for comment, statement in statements(text)
                    if statement.startswith('export ') and not statement.startswith('export type {')]  # which is said elsewhere
    return '\n\n'.join(part for part in out if part) + '\n'
