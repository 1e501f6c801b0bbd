#!/usr/bin/env python3
"""Includes run downwards: a folder includes what stands before it in LAYERS, and itself.

    layers_test.py ROOT
"""
import pathlib
import re
import sys

# From what knows nothing to what knows all. `slf` is include/slf, the public headers.
LAYERS = {
    'slf': [],
    'base': ['slf'],
    'bitstream': ['slf', 'base'],
    'entropy': ['slf', 'base', 'bitstream'],
    'geometry': ['slf', 'base', 'bitstream', 'entropy'],
    'attributes': ['slf', 'base', 'bitstream', 'entropy', 'geometry'],
    'video': ['slf', 'base', 'bitstream'],
    'texture': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'video'],
    'lightfield': ['slf', 'base', 'geometry'],
    'render': ['slf', 'base', 'geometry', 'lightfield'],
    'capture': ['slf', 'base', 'geometry'],
    'fit': ['slf', 'base', 'geometry', 'capture', 'lightfield', 'render'],
    'measure': ['slf', 'base', 'capture', 'lightfield', 'render', 'fit'],
    'refine': ['slf', 'base', 'capture', 'lightfield', 'render', 'fit', 'measure'],
    'train': ['slf', 'base', 'capture', 'render', 'fit', 'measure'],
    'codec': ['slf', 'base', 'bitstream', 'entropy', 'geometry', 'attributes', 'texture', 'lightfield'],
    'encoder': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'capture', 'lightfield', 'render', 'fit', 'measure',
                'refine', 'train', 'codec'],
    'scene': ['slf', 'base', 'bitstream', 'geometry', 'attributes', 'capture', 'lightfield', 'render', 'fit', 'codec',
              'encoder'],
    'igc': ['slf', 'base', 'bitstream', 'video', 'capture', 'lightfield', 'render', 'fit', 'encoder'],
    'plenoptic': ['slf', 'base', 'bitstream', 'entropy', 'capture', 'lightfield', 'fit', 'codec', 'encoder'],
    'exchange': ['slf', 'base', 'bitstream', 'capture', 'lightfield', 'render'],
    'capi': ['slf', 'base', 'bitstream', 'lightfield', 'render', 'codec'],
    'tools': ['slf'],
    'python': ['slf'],
    'examples': ['slf'],
}


NOT_CODE = {'bench', 'build', 'cmake', 'conformance', 'docs', 'fuzz', 'include', 'spec', 'tests', 'web'}  # or tests of it


def unknown_folders(root):
    for folder in sorted(root.iterdir()):
        known = folder.name in LAYERS or folder.name in NOT_CODE or folder.name.startswith(('build', '.'))
        if folder.is_dir() and not known and [*folder.glob('**/*.cpp')]:
            yield f'{folder.name}: not in LAYERS'


def wrong_includes(root):
    for folder, below in LAYERS.items():
        place = root / 'include/slf' if folder == 'slf' else root / folder
        for file in sorted([*place.glob('**/*.h'), *place.glob('**/*.cpp')]):
            for number, line in enumerate(file.read_text(encoding='utf-8').splitlines(), 1):
                included = re.match(r'#include "(\w+)/', line)
                if included and included[1] in LAYERS and included[1] not in [*below, folder]:
                    yield f'{file.relative_to(root)}:{number}: {folder} must not include {included[1]}'


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = [*unknown_folders(root), *wrong_includes(root)]
    print('\n'.join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
