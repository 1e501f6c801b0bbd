#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the six moving clouds of `slf synth` anew and says how frames resemble each other.

    moving.py --slf build/bin/slf --out build/moving [--frames 4] [--bits 8] [SCENE ...]

Columns: points; voxels that the frame before has too, without motion; the same after the best whole-voxel vector (+-6) for each
block of 16 x 16 x 16 voxels. Percent of the frame's points. Rows stand beside what a note measured on sequences made in the same
way (../shared/research, sequences, table A3).
"""
import argparse
import pathlib
import subprocess
import sys

import numpy as np

REACH = 6    # voxels of a vector, either way
BLOCK = 16   # voxels a side
# Points, percent shared without and with motion, of frame 4 from frame 3. Noise: no figure.
NOTED = {'rot1': (117586, 70, 94), 'rot4': (114946, 28, 86), 'tube2': (44400, 80, 92), 'tube8': (44400, 47, 89),
         'still': (None, 100, 100), 'noise': (None, None, None)}


def read_voxels(file):
    """Places of a binary PLY of `slf synth`: float x, y, z and three bytes of colour."""
    data = file.read_bytes()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    head = data[:end].decode('ascii').split('\n')
    count = next(int(line.split()[2]) for line in head if line.startswith('element vertex'))
    properties = [tuple(line.split()[1:]) for line in head if line.startswith('property')]
    wanted = [('float', n) for n in 'xyz'] + [('uchar', n) for n in ('red', 'green', 'blue')]
    if properties != wanted:
        sys.exit(f'{file}: not a cloud of slf synth --frames')
    rows = np.frombuffer(data, np.dtype([('at', '<f4', 3), ('colour', 'u1', 3)]), count, end)
    return rows['at'].astype(np.int64)


def by_block(voxels):
    """Voxels sorted by block, and where each block begins."""
    block = voxels // BLOCK
    key = (block[:, 2] << 40) | (block[:, 1] << 20) | block[:, 0]
    order = np.argsort(key, kind='stable')
    starts = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0])
    return voxels[order], starts


def shares(before, now):
    """Parts of `now` that `before` has: as it stands, and after the best vector of each block."""
    side = int(max(before.max(), now.max())) + 1 + 2 * REACH
    there = np.zeros((side,) * 3, bool)
    there[tuple((before + REACH).T)] = True
    flat = there.ravel()
    voxels, starts = by_block(now)
    at = ((voxels[:, 0] + REACH) * side + voxels[:, 1] + REACH) * side + voxels[:, 2] + REACH
    best = np.zeros(len(starts), np.int64)
    steps = range(-REACH, REACH + 1)
    for x in steps:
        for y in steps:
            for z in steps:
                hits = flat[at + (x * side + y) * side + z]
                best = np.maximum(best, np.add.reduceat(hits, starts, dtype=np.int64))
    return flat[at].mean(), best.sum() / len(now)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--slf', required=True)
    parser.add_argument('--out', required=True, type=pathlib.Path)
    parser.add_argument('--frames', type=int, default=4)
    parser.add_argument('--bits', type=int, default=8)
    parser.add_argument('scenes', nargs='*', metavar='SCENE', help=' '.join(NOTED))
    given = parser.parse_args()
    print('scene  frame   points  zero  block   noted')
    for scene in given.scenes or NOTED:
        directory = given.out / scene
        subprocess.run([given.slf, 'synth', scene, '--frames', str(given.frames), '--bits', str(given.bits),
                        '-o', directory, '--quiet'], check=True)
        clouds = [read_voxels(directory / f'frame_{number:04d}.ply') for number in range(1, given.frames + 1)]
        print(f'{scene:6} {1:5} {len(clouds[0]):8}')
        for number in range(2, given.frames + 1):
            zero, block = shares(clouds[number - 2], clouds[number - 1])
            noted = ' '.join('-' if n is None else str(n) for n in NOTED.get(scene, ()))
            print(f'{scene:6} {number:5} {len(clouds[number - 1]):8} {100 * zero:4.0f}% {100 * block:5.0f}%   '
                  f'{noted if number == given.frames else ""}'.rstrip(), flush=True)


if __name__ == '__main__':
    main()
