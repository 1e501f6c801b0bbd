#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Includes run downwards: a folder includes what stands before it in LAYERS, and itself.

    layers_test.py ROOT
"""
import pathlib
import re
import sys

# From what knows nothing to what knows all: each folder of code, by its path, knows those named and itself. A folder
# within another is a room of its own. `slf` is include/slf, the public headers.
LAYERS = {
    'slf': [],
    'base': ['slf'],
    'bitstream': ['slf', 'base'],
    'bitstream/encoder': ['slf', 'base', 'bitstream'],
    'entropy': ['slf', 'base', 'bitstream'],
    'geometry': ['slf', 'base', 'bitstream', 'entropy'],
    'geometry/encoder': ['slf', 'base', 'bitstream', 'entropy', 'geometry'],
    'attributes': ['slf', 'base', 'bitstream', 'entropy', 'geometry'],
    'attributes/encoder': ['slf', 'base', 'bitstream', 'entropy', 'geometry', 'attributes'],
    'attributes/video': ['slf', 'base', 'bitstream'],
    'attributes/video/encoder': ['slf', 'base', 'bitstream', 'attributes/video'],
    'attributes/texture': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'attributes/video'],
    'attributes/texture/encoder': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'attributes/video',
                                   'attributes/video/encoder', 'attributes/texture'],
    'lightfield': ['slf', 'base', 'geometry'],
    'lightfield/render': ['slf', 'base', 'geometry', 'lightfield'],
    'capture': ['slf', 'base', 'geometry'],
    'encoder/fit': ['slf', 'base', 'geometry', 'capture', 'lightfield', 'lightfield/render'],
    'encoder/measure': ['slf', 'base', 'capture', 'lightfield', 'lightfield/render', 'encoder/fit'],
    'encoder/refine': ['slf', 'base', 'capture', 'lightfield', 'lightfield/render', 'encoder/fit', 'encoder/measure'],
    'encoder/train': ['slf', 'base', 'capture', 'lightfield/render', 'encoder/fit', 'encoder/measure'],
    'codec': ['slf', 'base', 'bitstream', 'entropy', 'geometry', 'attributes', 'attributes/texture', 'lightfield'],
    'codec/decoder': ['slf', 'base', 'bitstream', 'entropy', 'geometry', 'attributes', 'attributes/texture',
                      'lightfield', 'codec'],
    'codec/encoder': ['slf', 'base', 'bitstream', 'bitstream/encoder', 'entropy', 'geometry', 'geometry/encoder',
                      'attributes', 'attributes/encoder', 'attributes/texture', 'attributes/texture/encoder',
                      'lightfield', 'codec'],
    'codec/stream': ['slf', 'base', 'bitstream', 'entropy', 'geometry', 'attributes', 'attributes/texture',
                     'lightfield', 'codec', 'codec/decoder', 'codec/encoder'],
    'encoder': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'capture', 'lightfield', 'lightfield/render',
                'encoder/fit', 'encoder/measure', 'encoder/refine', 'encoder/train', 'codec/decoder', 'codec/encoder'],
    'encoder/parts': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'attributes/encoder', 'capture', 'lightfield',
                      'lightfield/render', 'encoder/fit', 'codec', 'codec/decoder', 'codec/encoder', 'encoder'],
    'encoder/plenoptic': ['slf', 'base', 'bitstream', 'entropy', 'capture', 'lightfield', 'encoder/fit',
                          'codec/encoder', 'encoder'],
    'lightfield/splats': ['slf', 'base', 'bitstream', 'bitstream/encoder', 'capture', 'lightfield', 'lightfield/render'],
    'bindings/c': ['slf', 'base', 'bitstream', 'lightfield', 'lightfield/render', 'codec/stream'],
    'tools/synth': ['slf'],
    'tools/rd/igc': ['slf', 'base', 'bitstream', 'bitstream/encoder', 'attributes/video', 'attributes/video/encoder',
                     'capture', 'lightfield', 'lightfield/render', 'encoder/fit', 'encoder'],
    'tools': ['slf', 'tools/synth', 'tools/rd/igc'],
    'bindings/python': ['slf'],
    'docs/examples': ['slf'],
}


UNCHECKED = 'bitstream/unchecked_headers.h'  # for conformance streams and tests
NOT_CODE = {'build', 'conformance', 'docs', 'include', 'spec', 'tests', 'web'}  # or tests of it


def folders_of_code(root):
    """Folders with files of C++, but for what is no code of ours, as paths from the root."""
    for top in sorted(root.iterdir()):
        if top.is_dir() and top.name not in NOT_CODE and not top.name.startswith(('build', '.')):
            for folder in sorted({file.parent for kind in ('h', 'cpp') for file in top.glob(f'**/*.{kind}')}):
                yield folder.relative_to(root).as_posix()


def unknown_folders(root):
    for folder in folders_of_code(root):
        if folder not in LAYERS:
            yield f'{folder}: not in LAYERS'


def wrong_includes(root):
    for folder, below in LAYERS.items():
        place = root / ('include/slf' if folder == 'slf' else folder)
        for file in sorted([*place.glob('*.h'), *place.glob('*.cpp')]):
            for number, line in enumerate(file.read_text(encoding='utf-8').splitlines(), 1):
                included = re.match(r'#include "(?:([\w/]+)/)?\w+\.\w+"', line)
                if included and included[1] and included[1] not in [*below, folder]:
                    yield f'{file.relative_to(root)}:{number}: {folder} must not include {included[1]}'
                if included and UNCHECKED in line and folder != 'bitstream':
                    yield f'{file.relative_to(root)}:{number}: a coder writes headers that were checked, not {UNCHECKED}'


def missing_folders(root):
    for folder in LAYERS:
        if not (root / ('include/slf' if folder == 'slf' else folder)).is_dir():
            yield f'{folder}: in LAYERS, but not in the tree'


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = [*missing_folders(root), *unknown_folders(root), *wrong_includes(root)]
    print('\n'.join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
