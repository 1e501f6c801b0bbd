# SPDX-License-Identifier: Apache-2.0
"""The table of surfaces: from the same points, as they are given, mended, trained and as the default chooses; beside it trained splats in other formats."""
import json
import pathlib

from figures_tables import coded, table
from measured import run

TRANSFORM = pathlib.Path(__file__).resolve().parents[2] / 'tools/rd/splat_transform/node_modules/.bin/splat-transform'
SURFACES = {'`--surface given`': ['--surface', 'given'], '`--surface mended`': ['--surface', 'mended'], '`--surface trained`': ['--surface', 'trained'],
            'the default': []}
# What it starts from, the capture, the points in place of its own. The wheel is drawn by tools/captures/draw_capture.py, into WORK/wheel.
STARTS = [('middlebury_dino, hull', 'middlebury_dino', None), ('middlebury_dino, sparse points', 'middlebury_dino', 'sparse_points.ply'),
          ('blender_can, exact points', 'blender_can', None), ('blender_can, sparse points', 'blender_can', 'sparse_points.ply'),
          ('slf synth can, `--hull 4`', 'can_hull', None), ('slf synth die, `--hull 4`', 'die_hull', None),
          ('wheel, exact points', 'wheel', None), ('wheel, sparse points', 'wheel', 'sparse_points.ply')]
DRAWN = {'can_hull': ['can', '--size', '256x256', '--hull', 4], 'die_hull': ['die', '--size', '200x200', '--hull', 4]}
SPLATS = 6000  # at most, trained as splats are: as many as the yardstick's of the dino (decision 024)


def trained_splats(place, folder):
    """Splats of our own trainer, and the same by SPZ 4 and SOG 2 where splat-transform is (npm ci --prefix tools/rd/splat_transform)."""
    out = place.store.folder / f'splats_{folder.name}'
    out.mkdir(exist_ok=True)
    source = out / 'trained.ply'
    _, seconds, _ = run([next(place.build.rglob('bench_train')), folder, '', 3000, SPLATS, source])
    files = {'as trained': (source, source)}  # what has the bytes, and what is drawn
    for name, options in (('spz', []), ('sog', ['--gpu', 'cpu'])) if TRANSFORM.exists() else ():
        coded_file, again = out / f'trained.{name}', out / f'{name}.ply'
        run([TRANSFORM, '--overwrite', *options, source, coded_file])
        run([TRANSFORM, '--overwrite', coded_file, again])
        files[{'spz': 'SPZ v4', 'sog': 'SOG v2'}[name]] = coded_file, again
    rows = {}
    for name, (coded_file, drawn) in files.items():
        judged = json.loads(run([place.slf, 'eval', drawn, folder, '--json', '--quiet'])[0])['held_out']['image']
        rows[name] = [coded_file.stat().st_size, judged['psnr'], judged['all']['psnr'], judged['ssim'], seconds]
    return rows


def measured_rows(place, capture, points):
    """(surface, bytes, dB inside, dB over all, SSIM, seconds) of what is known."""
    for surface, options in SURFACES.items():
        c = coded(place, capture, [*options, *(['--points', place.capture(capture) / points] if points else [])])
        if c:
            out = c['held_out']
            yield surface, c['bytes'], out['psnr'], out['all']['psnr'], out['ssim'], c['encode']
    if not points:
        others = place.store.get(f'splats trained {capture}', lambda: trained_splats(place, place.capture(capture))) or {}
        yield from ((f'splats, {name}', *row) for name, row in others.items())


def surfaces(place):
    rows, missing = [], []
    for name, capture, points in STARTS:
        if capture in DRAWN:
            place.draw(*DRAWN[capture], folder=capture)
        own = list(measured_rows(place, capture, points)) if place.capture(capture) else []
        rows += [[name, surface, f'{size:,}', f'{inside:.2f}', f'{all_pixels:.2f}', f'{ssim:.3f}', f'{seconds:.0f}']
                 for surface, size, inside, all_pixels, ssim, seconds in own]
        missing += [] if own else [name]
    said = f' Not measured in this run: {", ".join(missing)}.' if missing else ''
    return ['Held-out pictures. Of synthetic hulls the exact clouds are in the table above. *Splats* are by the same trainer, drawn as 3-D Gaussian '
            f'splatting draws them: at most {SPLATS:,} of degree 3, written by @playcanvas/splat-transform; their seconds are those of the '
            f'training. A surface without a row was not measured in this run.{said}', '',
            *table(['from', 'surface', 'bytes', 'inside dB', 'all dB', 'SSIM', 's'], rows)]
