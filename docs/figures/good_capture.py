#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws good_capture.png: what photographs of an object should be like, and what they should not.

    slf synth can -o good --size 240x240 --circles 3 --per-circle 20
    slf synth can -o drift --size 240x240 --circles 3 --per-circle 20 --exposure-drift 0.3
    good_capture.py good drift OUT.png
"""
import json
import pathlib
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np


def centres(folder):
    cameras = json.loads((folder / 'cameras.json').read_text())['cameras']
    return np.array([-np.array(c['R']).T @ np.array(c['t']) for c in cameras]), [folder / c['image'] for c in cameras]


def strip(figure, bottom, files, title):
    figure.text(0.02, bottom + 0.205, title, fontsize=12)
    for column, file in enumerate(files):
        axes = figure.add_axes([0.02 + 0.162 * column, bottom, 0.155, 0.2])
        axes.imshow(plt.imread(file)[20:220], aspect='auto')
        axes.axis('off')


def above(figure, column, places, taken, title):
    figure.text(0.02 + 0.33 * column, 0.97, title, fontsize=12)
    axes = figure.add_axes([0.02 + 0.33 * column, 0.72, 0.26, 0.24])
    reach = 1.1 * np.abs(places).max()
    axes.add_patch(plt.Circle((0, 0), 0.12 * reach, color='#b8b4aa'))
    axes.scatter(*places[taken][:, :2].T, s=18, color='#1f5fa8')
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect='equal')
    axes.axis('off')


def main():
    good, drift, out = sys.argv[1:]
    places, photographs = centres(pathlib.Path(good))
    _, drifted = centres(pathlib.Path(drift))
    places -= places.mean(axis=0)
    figure = plt.figure(figsize=(10, 7.5))
    n = np.arange(len(places))
    for column, (taken, title) in enumerate(((n >= 0, 'Good: all around, three heights'), (n % 20 < 6, 'Not enough: from one side'),
                                             (n % 20 % 7 == 0, 'Not enough: too far apart'))):
        above(figure, column, places, taken, title)
    strip(figure, 0.48, photographs[20:26], 'Good: each photograph shows most of what the one before shows')
    strip(figure, 0.245, photographs[20:40:4] + photographs[:1], 'Too far apart: nothing tells how highlights move in between')
    strip(figure, 0.01, drifted[20:26], 'Automatic exposure and white balance: matched, but what is clipped stays lost')
    figure.savefig(out, dpi=80)


if __name__ == '__main__':
    main()
