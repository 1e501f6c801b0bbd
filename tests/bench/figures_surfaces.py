# SPDX-License-Identifier: Apache-2.0
"""The table of surfaces: from the same points, as they are given, mended, trained and as the default chooses; beside it trained splats in other formats."""
import csv
import json
import pathlib

from measured import run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SURFACES = ('given', 'mended', 'trained', 'auto')
# What it starts from, the capture, the points in place of its own. Hulls are drawn with `slf synth`, the wheel by tools/captures/draw_capture.py.
STARTS = [('blender_can, exact points', 'blender_can', None), ('blender_can, sparse points', 'blender_can', 'sparse_points.ply'),
          ('middlebury_dino, hull', 'middlebury_dino', None), ('middlebury_dino, sparse points', 'middlebury_dino', 'sparse_points.ply'),
          ('slf synth can, exact points', 'can', None), ('slf synth can, `--hull 4`', 'can_hull', None),
          ('slf synth die, exact points', 'die', None), ('slf synth die, `--hull 4`', 'die_hull', None),
          ('wheel, exact points', 'wheel', None), ('wheel, sparse points', 'wheel', 'sparse_points.ply')]
DRAWN = {'can': ['can', '--size', '256x256'], 'can_hull': ['can', '--size', '256x256', '--hull', 4],
         'die': ['die', '--size', '200x200'], 'die_hull': ['die', '--size', '200x200', '--hull', 4]}
SPLATS = 6000  # at most, trained as splats are: the number of the yardstick's (decision 024)


def folder_of(place, capture):
    """Where the capture is; None: it is not there."""
    if capture in DRAWN:
        return place.draw(*DRAWN[capture], folder=capture)
    return next((at / capture for at in (place.data, place.store.folder) if (at / capture).exists()), None)


def coded(place, folder, points, surface):
    file = place.store.folder / f'{folder.name}_{points or "own"}_{surface}.slf'
    from_points = ['--points', folder / points] if points else []
    text, seconds, _ = run([place.slf, 'encode', folder, '-o', file, '--json', '--quiet', '--surface', surface, *from_points])
    report = json.loads(text)
    judged = json.loads(run([place.slf, 'eval', file, folder, '--json', '--quiet'])[0])['held_out']['image']
    return {'bytes': report['bytes'], 'psnr': judged['psnr'], 'all': judged['all']['psnr'], 'ssim': judged['ssim'], 'seconds': seconds}


def trained_splats(place, folder, points):
    """Splats of our own trainer, and the same by SPZ 4 and SOG 2; {} where node has no writer of them."""
    out = place.store.folder / f'splats_{folder.name}_{points or "own"}'
    out.mkdir(exist_ok=True)
    source = out / 'trained.ply'
    _, seconds, _ = run([next(place.build.rglob('bench_train')), folder, folder / points if points else '', 3000, SPLATS, source])
    run(['/usr/bin/python3', ROOT / 'tools/rd/splats.py', folder, source, '--out', out])
    with open(out / 'splats.csv', encoding='utf-8') as file:
        return {row['format']: {'bytes': int(row['bytes']), 'psnr': float(row['psnr']), 'all': float(row['psnr_all']),
                                'ssim': float(row['ssim']), 'seconds': seconds} for row in csv.DictReader(file) if row['status'] == 'ok'}


def rows_of(place, name, folder, points):
    named = {f'`--surface {surface}`' if surface != 'auto' else 'the default':
             place.store.get(f'surface {folder.name} {points} {surface}', lambda s=surface: coded(place, folder, points, s)) for surface in SURFACES}
    others = place.store.get(f'splats trained {folder.name} {points}', lambda: trained_splats(place, folder, points)) or {}
    named |= {f'splats, {what}': others.get(key) for key, what in (('float', 'as trained'), ('spz', 'SPZ v4'), ('sog', 'SOG v2'))}
    for surface, c in named.items():
        if c:
            yield [name, surface, f"{c['bytes']:,}", f"{c['psnr']:.2f}", f"{c['all']:.2f}", f"{c['ssim']:.3f}", f"{c['seconds']:.0f}"]


def surfaces(place):
    rows, missing = [], []
    for name, capture, points in STARTS:
        folder = folder_of(place, capture)
        own = list(rows_of(place, name, folder, points)) if folder else []
        rows += own
        missing += [] if own else [name]
    said = f' Not measured in this run: {", ".join(missing)}.' if missing else ''
    return [f'Held-out pictures. *Splats* are at most {SPLATS:,} of degree 2 by the same trainer, drawn as 3-D Gaussian splatting draws them, written by '
            f'`tools/rd/splats.py` with @playcanvas/splat-transform; their seconds are those of the training.{said}', '',
            '| from | surface | bytes | inside dB | all dB | SSIM | s |', '| --- | --- | --- | --- | --- | --- | --- |',
            *('| ' + ' | '.join(row) + ' |' for row in rows)]
