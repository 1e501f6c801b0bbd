#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Streams of one format number never change: what changes them raises the number.

    version_is_true.py              compare every golden stream with the digest that is recorded for its number
    version_is_true.py --record     record streams that are new, and all of a number that is new
    version_is_true.py --record --encoder-alone
                                    record changed streams too: an encoder chose otherwise, and decoders of this
                                    number that are out there read the new streams as well as the old

digests/MAJOR.MINOR has a line for each stream, as sha256sum writes it. Digests of older numbers stay. From 1.0 on the streams stay too: those that are
recorded for any number of this major version are in the suite for ever, unchanged, and --encoder-alone is refused. A stream that the generator makes
otherwise gets another name; the old one is kept (kept.txt).
"""
import hashlib
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
LATER = {'later-minor', 'frames-of-a-later-version'}   # which show that a decoder reads them


def current_version():
    header = (HERE.parent / 'bitstream/sequence_parameter_set.h').read_text(encoding='utf-8')
    return tuple(map(int, re.search(r'kVersionMajor = (\d+), kVersionMinor = (\d+)', header).groups()))


FROZEN = current_version() >= (1, 0)


def version_of_text():
    text = (HERE.parent / 'spec/slf-bitstream.md').read_text(encoding='utf-8')
    return tuple(map(int, re.search(r'^Version \*\*(\d+)\.(\d+)\*\*', text, re.M).groups()))


def version_of_stream(data):
    """sps_version_major, sps_version_minor: behind signature and type of the first unit."""
    return tuple(data[9:11])


def digests():
    """Digest of every golden stream, and the names of those of another number."""
    found, others = {}, []
    for file in sorted(HERE.glob('streams/*/stream.slf')):
        data = file.read_bytes()
        found[file.parent.name] = hashlib.sha256(data).hexdigest()
        later = file.parent.name in LATER and version_of_stream(data) > current_version()
        older = FROZEN and version_of_stream(data) < current_version()
        if version_of_stream(data) != current_version() and not (later or older):
            others.append(file.parent.name)
    return found, others


def read_record(file):
    lines = file.read_text(encoding='utf-8').splitlines() if file.exists() else []
    return {name: digest for digest, name in (line.split('  ') for line in lines)}


def frozen():
    """Name and digest of the streams of every number of this major version; before 1.0 numbers are drafts."""
    streams = {}
    for file in sorted((HERE / 'digests').glob(f'{current_version()[0]}.*')) if FROZEN else ():
        streams |= read_record(file)
    return streams


def gone(found):
    for name, digest in frozen().items():
        if found.get(name) != digest:
            yield f'{name}: changed or gone; streams stay as they are from 1.0 on (spec/registry.md)'


def complaints(recorded, found, others, number):
    for name in others:
        yield f'{name}: a stream of another number than {number}'
    for name in sorted(recorded.keys() - found.keys()):
        yield f'{name}: recorded for {number} and gone; streams of a number stay'
    for name in sorted(found.keys() - recorded.keys()):
        yield f'{name}: not recorded for {number} (--record)'
    for name in sorted(recorded.keys() & found.keys()):
        if recorded[name] != found[name]:
            yield f'{name}: not the stream of {number} any more; what changes streams raises the number (sequence_parameter_set.h, spec 7.2)'


def main():
    options = sys.argv[1:]
    if set(options) - {'--record', '--encoder-alone'} or (FROZEN and '--encoder-alone' in options):
        sys.exit(__doc__)
    number = '.'.join(map(str, current_version()))
    file = HERE / 'digests' / number
    recorded, (found, others) = read_record(file), digests()
    if '--record' in options:
        recorded = {**found, **({} if '--encoder-alone' in options else recorded)}
        file.parent.mkdir(exist_ok=True)
        file.write_text(''.join(f'{recorded[name]}  {name}\n' for name in sorted(recorded)), encoding='utf-8')
    wrong = list(complaints(recorded, found, others, number)) + list(gone(found))
    if version_of_text() != current_version():
        wrong.append(f'the text says {version_of_text()}, the code {current_version()}')
    print('\n'.join(wrong) or f'{len(found)} streams are those of {number}')
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
