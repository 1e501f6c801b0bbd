#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A light field in numpy: the view map of one point, a rendering, and quality against bytes.

    notebook.py CAPTURE PICTURE.png        needs the Python package slf and matplotlib

Cells are marked as notebooks mark them.
"""
# %% Encode a capture with several quantisers
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np

import slf

capture, picture = sys.argv[1:]
fine = slf.encode(capture, q=2, effort=3)
coded = [slf.encode(capture, q=q, effort=3) for q in (8, 16, 32, 64, 128)]
field = slf.read(fine.data)
print(field, fine.bits, 'bits')

# %% The view map of the point whose colour changes most, over azimuth and sine of the elevation
theta, gamma = np.meshgrid(np.linspace(-np.pi, np.pi, 181), np.linspace(1, -1, 91))
across = np.sqrt(1 - gamma**2)
directions = np.stack([across * np.cos(theta), across * np.sin(theta), gamma], axis=-1)
sample = np.linspace(0, len(field) - 1, 200).astype(int)
changes = field.radiance(sample[:, None], directions[::15, ::20].reshape(-1, 3)).std(axis=1).sum(axis=1)
point = sample[changes.argmax()]
view_map = field.radiance(point, directions) / 255

# %% A rendering, and the colours of the finest against those of the others along the same directions
rendering = field.render(field.orbit(0.1, elevation=30, size=(480, 480)))
along = directions[::15, ::20].reshape(-1, 3)


def psnr(encoded):
    """PSNR of colours of the same voxels, against the finest."""
    other = slf.read(encoded.data)
    mine = {tuple(v): p for p, v in enumerate(field.positions)}
    pairs = [(mine[tuple(v)], p) for p, v in enumerate(other.positions) if tuple(v) in mine][::7]
    a, b = np.array(pairs).T
    difference = field.radiance(a[:, None], along) - other.radiance(b[:, None], along)
    return 10 * np.log10(255**2 / np.mean(difference**2))


rate = [8 * len(e.data) / e.points for e in coded]
quality = [psnr(e) for e in coded]

# %% Draw all three
figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.2))
left.imshow(view_map, extent=(-180, 180, -1, 1), aspect='auto')
left.set(title=f'view map of point {point}', xlabel='azimuth, degrees', ylabel='sine of the elevation')
middle.imshow(rendering)
middle.set(title='a view where no camera stood')
middle.axis('off')
right.plot(rate, quality, 'o-')
right.set(title='colours against those of q = 2', xlabel='bits per point', ylabel='PSNR, dB')
right.grid(alpha=0.3)
figure.tight_layout()
figure.savefig(picture, dpi=100)
