#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two builds of slf, in turns: bytes, user seconds, peak memory; of the same integers, or of captures.

    tests/bench/compare_versions.py OLD_SLF NEW_SLF [--runs 3] [--cloud FILE.ply ...]
        [--planes POSITIONS.npy COMPONENTS.npy STEP NAME ...] [--large BITS]
        [--capture DIR ... [--bits 8 9] [--q 8 16 32]]

Prints Markdown tables, a row an input: what `pack` writes, and what it and `decode` take. Of captures
what `encode` writes at each version's own defaults, once, and what its pictures of held-out cameras
are worth. Seconds are user time of one thread, least of the runs; two threads are seconds on the
clock. Memory is the greatest resident set. Needs numpy.
"""
import argparse
import json
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np


def large_cloud(bits, folder):
    """Writes a wavy torus of some 0.33 * 4^bits voxels with a colour that changes slowly along it."""
    side = 1 << bits
    wide, thin = 0.14 * side, 0.047 * side
    u = np.linspace(0, 2 * np.pi, int(9 * wide), endpoint=False)
    v = np.linspace(0, 2 * np.pi, int(9 * thin), endpoint=False)
    codes = []
    for part in np.array_split(u, 64):
        a, b = np.meshgrid(part, v, indexing='ij')
        radius = thin * (1 + 0.10 * np.sin(9 * a) * np.cos(5 * b) + 0.02 * np.sin(61 * a + 47 * b))
        around = wide + radius * np.cos(b)
        xyz = np.stack([around * np.cos(a), around * np.sin(a), radius * np.sin(b)], -1) + side / 2
        x, y, z = np.floor(xyz.reshape(-1, 3)).astype(np.int64).T
        codes.append(np.unique(x | y << 21 | z << 42))
    codes = np.unique(np.concatenate(codes))
    mask = (1 << 21) - 1
    p = np.stack([codes & mask, codes >> 21 & mask, codes >> 42], 1).astype(np.int32)
    s = p / side
    shade = [np.sin(7 * s @ [1, 0.3, 0.2]), np.cos(11 * s @ [0.2, 1, 0.4]), np.sin(5 * s @ [1, 1, 1])]
    noise = np.random.default_rng(1).normal(0, 2, p.shape)
    colour = np.clip(128 + 80 * np.stack(shade, 1) + noise, 0, 255).round().astype(np.int32)
    np.save(folder / 'large_p.npy', p)
    np.save(folder / 'large_c.npy', colour[:, None, :])


def run(command):
    """User seconds, seconds on the clock, MiB."""
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f'failed: {" ".join(map(str, command))}')
    return usage.ru_utime, time.monotonic() - begin, usage.ru_maxrss / 1024


def in_turns(commands, runs):
    """The least of every figure, of each command; the commands take turns."""
    best = [np.full(3, np.inf) for _ in commands]
    for _ in range(runs):
        for i, command in enumerate(commands):
            best[i] = np.minimum(best[i], run(command))
    return best


def measure(name, positions, components, options, programs, runs, folder):
    files = [folder / f'{i}.slf' for i in range(len(programs))]
    what = [positions] + ([components] if components else [])
    packs = in_turns([[p, 'pack', *what, *options, '-j', '1', '--quiet', '-o', f]
                      for p, f in zip(programs, files)], runs)
    one, two = decodes(files, programs, runs, ['--dump', folder / 'out'])
    print_row(name, [str(f.stat().st_size) for f in files], [f'{r[0]:.2f}, {r[2]:.0f}' for r in packs],
              [f'{r[0]:.3f}, {r[2]:.0f}' for r in one], [f'{r[1]:.3f}' for r in two])


def measure_capture(name, capture, bits, q, programs, runs, folder):
    files = [folder / f'{i}.slf' for i in range(len(programs))]
    encode = ['encode', capture, '--grid-bits', str(bits), '-q', str(q), '--quiet']
    one, two = on_threads([[p, *encode, '-o', f] for p, f in zip(programs, files)], 1)
    points = decodes(files, programs, runs, ['-o', folder / 'points.ply'])
    everything = decodes(files, programs, runs, ['--dump', folder / 'out'])
    print_row(f'{name}, {bits} bits, Q = {q}',
              [f'{f.stat().st_size}, {held_out(p, f, capture):.2f}' for p, f in zip(programs, files)],
              [f'{a[0]:.1f}, {b[1]:.1f}, {a[2]:.0f}' for a, b in zip(one, two)],
              *([f'{a[0]:.3f}, {b[1]:.3f}, {a[2]:.0f}' for a, b in zip(*kind)] for kind in (points, everything)))


def held_out(program, file, capture):
    """PSNR of the pictures of cameras that were held out, dB."""
    told = subprocess.run([program, 'eval', file, capture, '--json'], check=True, capture_output=True)
    return json.loads(told.stdout)['held_out']['image']['psnr']


def decodes(files, programs, runs, what):
    return on_threads([[p, 'decode', f, *what, '--quiet'] for p, f in zip(programs, files)], runs)


def on_threads(commands, runs):
    """in_turns() on one and on two threads."""
    return [in_turns([[*command, '-j', threads] for command in commands], runs) for threads in ('1', '2')]


def print_row(*cells):
    flat = [c for cell in cells for c in (cell if isinstance(cell, list) else [cell])]
    print('| ' + ' | '.join(flat) + ' |', flush=True)


def print_head(*columns):
    pairs = [name for column in columns for name in (f'{column}, old', 'new')]
    print('| | ' + ' | '.join(pairs) + ' |\n' + '|---' * (len(pairs) + 1) + '|')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('old')
    parser.add_argument('new')
    parser.add_argument('--runs', type=int, default=3)
    parser.add_argument('--cloud', nargs='*', default=[])
    parser.add_argument('--planes', nargs=4, action='append', default=[],
                        metavar=('POSITIONS', 'COMPONENTS', 'STEP', 'NAME'))
    parser.add_argument('--options', default='', help='of pack, for --planes')
    parser.add_argument('--large', type=int, metavar='BITS')
    parser.add_argument('--capture', nargs='*', default=[])
    parser.add_argument('--bits', nargs='*', default=[8, 9])
    parser.add_argument('--q', nargs='*', default=[8, 16, 32])
    args = parser.parse_args()
    programs = [args.old, args.new]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        if args.capture:
            costs = 's, s of two threads, MiB'
            print_head('bytes, dB', f'encode {costs}', f'decode -o {costs}', f'--dump {costs}')
        for capture in args.capture:
            for bits in args.bits:
                for q in args.q:
                    measure_capture(pathlib.Path(capture).name, capture, bits, q, programs, args.runs, folder)
        print_head('bytes', 'pack s, MiB', 'decode s, MiB', 'two threads s')
        for cloud in args.cloud:
            measure(pathlib.Path(cloud).stem, cloud, None, [], programs, args.runs, folder)
        for positions, components, step, name in args.planes:
            measure(name, positions, components, ['--step', step, *args.options.split()], programs,
                    args.runs, folder)
        if args.large:
            # In a process of its own: the greatest resident set of a child begins with its parent's.
            maker = multiprocessing.Process(target=large_cloud, args=(args.large, folder))
            maker.start()
            maker.join()
            measure(f'torus of {args.large} bits', folder / 'large_p.npy', folder / 'large_c.npy',
                    ['--step', '8'], programs, args.runs, folder)


if __name__ == '__main__':
    main()
