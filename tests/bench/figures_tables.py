# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/figures.md: each makes lines of Markdown from what it measures."""
import gzip
import json
import pathlib
import re
import shutil
import subprocess
from dataclasses import dataclass

from measured import Store, run

# Figures of other programs, from the pages of docs/decisions that have their conditions.
SPZ = {'can_n4000_s3': ('84,154', '24.09', '0.901'), 'can_n20000_s3': ('403,843', '24.87', '0.943'), 'dino_n6000_s2': ('94,525', '29.38', '0.930')}
SOG = {'can_n4000_s3': ('152,963', '24.54', '0.908'), 'can_n20000_s3': ('907,861', '25.45', '0.951'), 'dino_n6000_s2': ('191,124', '30.17', '0.936')}
SPLATS = {'can_n4000_s3': ('blender_can', '4,000 splats of degree 3'), 'can_n20000_s3': ('blender_can', '20,000 of degree 3'),
          'dino_n6000_s2': ('middlebury_dino', '6,000 of degree 2')}
# A name, the capture, the options of encode.
PICTURES = [('the default', 'blender_can', []), ('`-q 32`', 'blender_can', ['-q', 32]), ('`-q 64`', 'blender_can', ['-q', 64]),
            ('the paper as written, `--preset paper -q 8`', 'blender_can', ['--preset', 'paper', '-q', 8]),
            ('`--preset paper -q 32`', 'blender_can', ['--preset', 'paper', '-q', 32]),
            ('the default, from 9,230 sparse points', 'blender_can', ['--points', '{data}/blender_can/sparse_points.ply']),
            ('`--effort 1 -q 24`', 'blender_can', ['--effort', 1, '-q', 24]), ('`--effort 3 -q 24`', 'blender_can', ['--effort', 3, '-q', 24]),
            ('`--effort 5 -q 24`', 'blender_can', ['--effort', 5, '-q', 24]), ('`--effort 7 -q 24`', 'blender_can', ['--effort', 7, '-q', 24]),
            ('`--effort 8 -q 24`', 'blender_can', ['--effort', 8, '-q', 24]),
            ('the default: it takes splats', 'middlebury_dino', []), ('`--surface trained`', 'middlebury_dino', ['--surface', 'trained']),
            ('`--surface given`', 'middlebury_dino', ['--surface', 'given']),
            ('the default', 'can', []), ('the default', 'die', []), ('`-q 16`', 'die', ['-q', 16])]
DRAWN = {'can': 'slf synth can, 256 × 256', 'die': 'slf synth die, 200 × 200'}
MOVING = {'rot1': 'a can that turns by 1 degree a frame', 'rot4': 'by 4 degrees', 'tube2': 'a tube that twists and bends, slowly', 'tube8': 'fast',
          'still': 'nothing moves', 'noise': 'every point moves by 0.3 voxels'}
SEEK = ('tube2', 'rot1')


@dataclass
class Place:
    build: pathlib.Path
    data: pathlib.Path
    clouds: pathlib.Path
    store: Store

    @property
    def slf(self):
        return self.build / 'bin/slf'

    def bench(self, name, *words):
        return run([next(self.build.rglob(name)), *words])[0]

    def capture(self, name):
        """The directory of a capture; None where it is not there. Those of `slf synth` are drawn when they are needed."""
        own = self.store.folder / name
        return next((folder for folder in (own, self.data / name) if folder.exists()), own if name in DRAWN else None)

    def draw(self, name, *options, folder=None):
        folder = self.store.folder / (folder or name)
        if not folder.exists():
            run([self.slf, 'synth', name, *options, '-o', folder])
        return folder


def table(header, rows):
    rows = [list(header), ['---'] * len(header), *rows]
    return ['| ' + ' | '.join(str(cell) for cell in row) + ' |' for row in rows]


def coded(place, capture, options):
    """A capture encoded, decoded, drawn and judged: what the table needs. None where nothing is known and nothing is to be measured."""
    folder = place.capture(capture)
    options = [str(word).replace('{data}', str(place.data)) for word in options]

    def make():
        if capture in DRAWN:
            place.draw(capture, '--size', DRAWN[capture].split(', ')[1].replace(' × ', 'x'))
        file = place.store.folder / f'{capture}{re.sub("[^a-z0-9]+", "-", " ".join(options))}.slf'
        text, encode, memory = run([place.slf, 'encode', folder, '-o', file, '--json', '--quiet', *options])
        report = json.loads(text)
        judged = json.loads(run([place.slf, 'eval', file, folder, '--json', '--quiet'])[0])
        decode = min(run([place.slf, 'decode', file, '--dump', place.store.folder / 'dump', '-j', 1, '--quiet'])[1] for _ in range(3))
        return {'file': str(file), 'bytes': report['bytes'], 'points': report['points'], 'q': report['q'], 'encode': encode, 'memory': memory,
                'decode': decode, 'held_out': judged['held_out']['image'], 'input': judged['input']['image']}
    return place.store.get(f'coded {capture} {" ".join(options)}', make)


def pictures(place):
    rows, missing = [], []
    for name, capture, options in PICTURES:
        c = coded(place, capture, options) if place.capture(capture) else None
        if c is None:
            missing.append(f'{DRAWN.get(capture, capture)}, {name}')
            continue
        out, seen = c['held_out'], c['input']
        rows.append([DRAWN.get(capture, capture), name, f"{c['q']:g}", f"{c['points']:,}", f"{c['bytes']:,}", f"{8 * c['bytes'] / c['points']:.1f}",
                     f"{out['psnr']:.2f}", f"{out['all']['psnr']:.2f}", f"{out['ssim']:.3f}", f"{seen['psnr']:.2f}", f"{c['encode']:.0f}",
                     f"{c['memory'] / 1024:.1f}", f"{c['decode']:.2f}"])
    return ['Whole files. *Decode* is the program with `--dump`: all components, one thread, writing included.', '',
            *table(['capture', 'encoder', 'Q', 'points', 'bytes', 'bits/point', 'held out, inside dB', 'all dB', 'SSIM', 'input, inside dB',
                    'encode s', 'peak GiB', 'decode s'], rows),
            *(['', 'Not measured in this run:', '', *(f'* {name}' for name in missing)] if missing else [])]


def splats(place):
    rows = []
    for name, (capture, what) in SPLATS.items():
        source = place.data / 'splats' / f'{name}.ply'
        if not source.exists():
            continue
        row = [f'{capture}, {what}']
        for size, psnr, ssim in (SPZ[name], SOG[name]):
            row.append(f'{size} B {psnr} dB {ssim}')
        for q in (9, 7, 5):
            def make(q=q):
                file = place.store.folder / f'{name}-{q}.slf'
                report = json.loads(run([place.slf, 'encode', source, '-o', file, '--json', '--quiet', '-q', q])[0])
                judged = json.loads(run([place.slf, 'eval', file, place.data / capture, '--json', '--quiet'])[0])
                return {'bytes': report['bytes'], 'held_out': judged['held_out']['image']}
            c = place.store.get(f'splats {name} {q}', make)
            row.append('' if c is None else f"{c['bytes']:,} B {c['held_out']['psnr']:.2f} dB {c['held_out']['ssim']:.3f}")
        rows.append(row)
    return ['Splats that another program trained, as files of three formats. Held out, inside / SSIM. SPZ v4 and SOG v2 are written by '
            '@playcanvas/splat-transform 2.7.1 ([decision 024](decisions/024-gaussian-splats.md)).', '',
            *table(['splats', 'SPZ v4', 'SOG v2', '`slf -q 9`', '`-q 7`, the default', '`-q 5`'], rows)]


def geometry(place):
    files = sorted(place.clouds.glob('*.ply'))
    if not files:
        return ['No clouds on this machine.']
    text = place.store.get('geometry', lambda: place.bench('bench_geometry', *files)) or ''
    rows = []
    for line in text.splitlines():
        found = re.match(r'(\S+)\s+(\d+) \|\s+(\d+)\s+([\d.]+)\s+[\d.]+\s+[\d.]+ \|\s+(\d+)\s+[\d.]+\s+[\d.]+ \|\s+(\d+)\s+(\S+%)', line)
        if found:
            name, points, size, rate, draco, tmc, change = found.groups()
            rows.append([name, f'{int(points):,}', f'{int(size):,}', rate, f'{int(tmc):,}', change.replace('%', ' %').replace('-', '−'), f'{int(draco):,}'])
    mean = re.search(r'mean against TMC13: (\S+) %', text)
    return ['Lossless positions on a grid. Whole `.slf` files against the position bytes of the reference software of G-PCC (TMC13 v23.0-rc2, the better '
            f'of planar on and off) and Draco. Mean against TMC13: {mean[1] if mean else "?"} %.', '',
            *table(['cloud', 'points', 'slf, bytes', 'bits/point', 'TMC13, bytes', 'slf against TMC13', 'Draco, bytes'], rows)]


def speed(place):
    if place.capture('blender_can') is None:
        return ['blender_can is not on this machine.']
    c = coded(place, 'blender_can', [])
    if c is None:
        return ['Not measured in this run.']

    def make():
        parts = {}
        for name, options in [('points and mean colours, `-o x.ply`', []), ('fewer levels, `--levels 7`', ['--levels', 7]),
                              ('one group, `--groups 1`', ['--groups', 1])]:
            runs = [run([place.slf, 'decode', c['file'], '-o', place.store.folder / 'out.ply', '-j', 1, '--quiet', *options]) for _ in range(5)]
            parts[name] = min(seconds for _, seconds, _ in runs), min(memory for _, _, memory in runs)
        whole = [run([place.slf, 'decode', c['file'], '--dump', place.store.folder / 'dump', '-j', 1, '--quiet']) for _ in range(5)]
        parts['all components, `--dump`'] = min(s for _, s, _ in whole), min(m for _, _, m in whole)
        return parts
    rows = [[name, f'{seconds:.3f}', f'{memory:.0f}'] for name, (seconds, memory) in (place.store.get('speed', make) or {}).items()]
    frame = place.store.get('frame', lambda: place.bench('bench_render', c['file'], 800, 6)) or '? ms a frame'
    ms = re.search(r'([\d.?]+) ms a frame', frame)[1]
    return [f"The default file of blender_can ({c['bytes']:,} B), one thread, the whole program, least of five. A picture of 800 × 800 takes {ms} ms.", '',
            *table(['`slf decode`', 'seconds', 'peak MiB'], rows)]


def moving(place):
    text = place.store.get('moving', lambda: place.bench('bench_frames', 16, *[place.draw(name, '--frames', 6) for name in MOVING])) or ''
    rows, name, by_kind = [], None, {}
    for line in text.splitlines():
        words = line.split()
        if line and not line[0].isspace() and 'frames' in line:
            name, by_kind = pathlib.Path(line.split(',')[0]).name, {}
        elif len(words) >= 7 and name:
            by_kind[' '.join(words[:-6])] = words[-6:]
        elif len(words) == 3 and all(word.endswith('%') for word in words):
            own, predicted = by_kind['by itself'], by_kind['predicted']
            changes = [word.replace('%', ' %').replace('-', '−') for word in words]
            rows.append([f'{name}: {MOVING[name]}', f'{int(own[0]):,}', f'{int(predicted[0]):,}', *changes])
    return ['Clouds of one colour a point on a grid of 8 bits, step 16 (`tests/bench/bench_frames`): bytes a frame, coded by itself and predicted from the '
            'frame before, at the same step.', '',
            *table(['sequence', 'alone, bytes', 'predicted, bytes', 'all', 'geometry', 'values'], rows)]


def seeking(place):
    """Files of two groups of 16 frames."""
    def make():
        files = []
        for name in SEEK:
            files.append(place.store.folder / f'{name}_seek.slf')
            run([place.slf, 'encode', place.draw(name, '--frames', 32, folder=f'{name}_32'), '-q', 16, '--grid-bits', 8, '-o', files[-1], '--quiet'])
        return place.bench('bench_seek', *files)
    rows = []
    for line in (place.store.get('seeking', make) or '').splitlines()[1:]:
        path, numbers = line.rsplit(':', 1)
        n = [float(word) for word in numbers.split()]
        rows.append([pathlib.Path(path.split(',')[0]).stem.split('_')[0], f'{n[0]:,.0f}', f'{n[1]:,.0f}',
                     f'{n[2]:.0f}', f'{n[3]:.0f}', f'{n[4]:.1f}', f'{n[5]:.0f}'])
    return ['Files of 32 frames in two groups of 16 (`tests/bench/bench_seek`, one thread): what a reader needs from nothing to a frame of the '
            'first group, mean and worst over its frames, and how many frames are not shown where the largest unit of a frame is '
            'missing. Frames of the second group are never among them.', '',
            *table(['sequence', 'mean, bytes', 'worst, bytes', 'mean, ms', 'worst, ms', 'frames lost, mean', 'worst'], rows)]


def packed(file):
    """Bytes of a file as it is, by gzip, and by brotli where that is there."""
    data = file.read_bytes()
    brotli = shutil.which('brotli')
    small = f"{len(subprocess.run([brotli, '-c', '-q', '11', file], capture_output=True, check=True).stdout):,}" if brotli else ''
    return [f'{len(data):,}', f'{len(gzip.compress(data, 9)):,}', small]


def pages(place):
    web = pathlib.Path(__file__).resolve().parents[2] / 'web'
    rows = [[f'`{name}`', *packed(web / name)] for name in ('slf.wasm', 'slf_scalar.wasm') if (web / name).exists()]
    for capture in ('can', 'blender_can'):
        c = coded(place, capture, []) if place.capture(capture) else None
        if c is None:
            continue

        def make(c=c):
            page = place.store.folder / 'page.html'
            run([place.slf, 'html', c['file'], '-o', page, '--quiet'])
            return packed(page)
        sizes = place.store.get(f'page {capture}', make)
        if sizes:
            rows.append([f"`slf html`, {DRAWN.get(capture, capture)}, a file of {c['bytes']:,} B", *sizes])
    return ['One page holds the file, the decoder, the viewer and one or two posters.', '', *table(['', 'bytes', 'gzip -9, bytes', 'brotli 11, bytes'], rows)]
