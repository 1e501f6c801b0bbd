#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The decoder written from the text where no stream of the suite asks it: beginnings of a stream, and headers of fewer levels.

    test_text_decoder.py [SLF]

With SLF, the program, headers and refusals are those of the program too. Needs numpy. Exit code: 0 all passed.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SIGNATURE = bytes.fromhex('8B534C460D0A1A0A')
DECODERS = [[sys.executable, str(HERE.parent / 'spec/decoder.py')]] + [[name] for name in sys.argv[1:]]


def decoded(decoder, data, folder, *options):
    """Exit code, what is said of an error, and the header of what is given out."""
    stream, out = folder / 'stream.slf', folder / 'out'
    stream.write_bytes(data)
    done = subprocess.run([*decoder, 'decode', stream, '--dump', out, *options], capture_output=True, text=True)
    header = out / 'light_field.json'
    return done.returncode, done.stderr, json.loads(header.read_text(encoding='utf-8')) if header.exists() else None


def nothing_of_a_stream_is_refused(decoder, folder):
    """7.1: no byte, a part of the signature, the signature alone."""
    for length in range(9):
        code, said, header = decoded(decoder, SIGNATURE[:length], folder)
        element = 'unit_type' if length == 8 else 'signature'
        assert code != 0 and element in said and 'Traceback' not in said and header is None, (length, code, said)


def cells_of_normals_are_those_of_the_grid_given_out(decoder, folder):
    """6.6: cells stay as wide in the world, and have a voxel at least, where fewer levels are asked for."""
    data = (HERE / 'streams/header-order-2/stream.slf').read_bytes()
    whole = decoded(decoder, data, folder)[2]
    bits, cell = whole['grid']['bits'], whole['normal_cell']
    assert cell == 4
    for levels in range(1, bits):
        header = decoded(decoder, data, folder, '--levels', str(levels))[2]
        assert header['grid']['bits'] == levels
        assert header['normal_cell'] == max(cell >> bits - levels, 1), (levels, header['normal_cell'])


TESTS = nothing_of_a_stream_is_refused, cells_of_normals_are_those_of_the_grid_given_out
for check in TESTS:
    for program in DECODERS:
        with tempfile.TemporaryDirectory() as place:
            check(program, pathlib.Path(place))
print(f'{len(TESTS) * len(DECODERS)} passed, 0 failed')
