#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The decoder written from the text alone, spec/decoder.py, against the conformance streams.

    text_agrees.py [--part I N] [NAME ...]

The same checks as run.py makes of a program, but every stream is read once for all that its manifest asks of it, which takes
a tenth of the time. --part: each N-th of them from the I-th on. Draco's payloads are left out: no part of them is in the text. Needs numpy.
"""
import argparse
import hashlib
import json
import multiprocessing
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / 'spec'))
import decoder  # noqa: E402
import numpy as np  # noqa: E402


def digest(array, kind):
    return hashlib.sha256(array.astype(kind).tobytes()).hexdigest()


def differences(sequence, light_field, expect):
    """What is not as the manifest has it, of one request."""
    wanted = decoder.Wanted(sequence, expect['levels'], expect['groups'], expect.get('layers', 0))
    positions, components, normals = decoder.given_out(sequence, light_field, wanted, expect.get('region'))
    if len(positions) != expect['points'] or components.shape[1] != expect['components']:
        yield f'{components.shape} points and components'
        return
    arrays = {'positions': (positions, '<i4'), 'components': (components, '<i4'), 'normals': (normals, '<u2')}
    if 'planes_sha256' in expect:
        arrays['planes'] = (decoder.given_planes(sequence, wanted.coded, components.astype(np.int64)), '<i4')
    for name, (array, kind) in arrays.items():
        if f'{name}_sha256' in expect and digest(array, kind) != expect[f'{name}_sha256']:
            yield name


def check(folder):
    """Name of the case, and what is wrong with it."""
    case = json.loads((folder / 'case.json').read_text(encoding='utf-8'))
    name = f'{folder.parent.name}/{folder.name}'
    if case.get('refuse', {}).get('by', 'decode') != 'decode':
        return name, []  # nothing that a decoder looks at
    data = (folder / case['stream']['file']).read_bytes()
    try:
        frames = []
        for _, light_field in decoder.light_fields(data):
            frames.append(light_field)
            if 'refuse' in case:
                sequence = light_field.sequence
                decoder.given_out(sequence, light_field, decoder.Wanted(sequence, 0, 0, 0), None)
        if 'refuse' in case:
            return name, ['is not refused']
        return name, [f'{expect["levels"]} levels, {expect["groups"]} groups, {expect.get("layers", 0)} layers: {problem}'
                      for expect in case['expect'] for light_field in [frames[expect.get('frame', 0)]]
                      for problem in differences(light_field.sequence, light_field, expect)]
    except decoder.Refused as problem:
        wanted = case.get('refuse', {})
        unsupported = isinstance(problem, decoder.Unsupported) == (wanted.get('code') == 'kUnsupported')
        agrees = str(problem).split(' (')[0] == wanted.get('element') and unsupported
        return name, [] if agrees else [f'is {problem.said}: {problem}']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--part', type=int, nargs=2, default=(0, 1), metavar=('I', 'N'))
    parser.add_argument('name', nargs='*')
    given = parser.parse_args()
    folders = [f for part in ('streams', 'refused', 'refused_frames') for f in sorted((HERE / part).iterdir())
               if (f / 'case.json').exists() and f.name != 'draco' and (not given.name or f.name in given.name)]
    folders = folders[given.part[0]::given.part[1]]
    failed = 0
    with multiprocessing.Pool() as pool:
        for name, problems in pool.imap_unordered(check, folders):
            failed += bool(problems)
            for problem in problems:
                print(f'{name}: {problem}', flush=True)
    print(f'{len(folders) - failed} of {len(folders)} agree')
    sys.exit(1 if failed else 0)


if __name__ == '__main__':
    main()
