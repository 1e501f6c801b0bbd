# SPDX-License-Identifier: Apache-2.0
"""Planes of numbers on points by `slf pack`: RAHT, prediction between levels and the adaptive coder that our files have."""
import json
import pathlib
import subprocess
import tempfile

import numpy as np

UNIT = 64            # components of a grey level
GEOMETRY, COLOUR = "geometry", "colour"
OPPONENT = np.array([[1, 1, 1], [1, 0, -1], [1, -2, 1]]) / np.sqrt([[3], [2], [6]])  # orthonormal, as our files' (spec 6.5)


class Packer:
    """`slf` and the points that it packs planes on."""

    def __init__(self, slf, positions, threads=2):
        self.slf, self.positions, self.threads = slf, np.asarray(positions, np.int32), threads
        self.geometry = self.run(None, [])[0]

    def run(self, integers, options):
        """(bytes of a file, what a decoder has)."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            np.save(folder / "positions.npy", self.positions)
            words = [self.slf, "pack", folder / "positions.npy"]
            if integers is not None:
                np.save(folder / "components.npy", integers)
                words += [folder / "components.npy"]
            said = subprocess.run([*words, "-o", folder / "x.slf", "--json", "-j", str(self.threads), *options],
                                  capture_output=True, text=True)
            if said.returncode:
                raise RuntimeError(f"slf pack: {said.stderr.strip()}")
            size = json.loads(said.stdout)["bytes"]
            if integers is None:
                return size, None
            subprocess.run([self.slf, "decode", folder / "x.slf", "--dump", folder / "d", "--planes", "--quiet", "-j", str(self.threads)],
                           check=True, capture_output=True)
            return size, self.in_order(np.load(folder / "d" / "positions.npy"), np.load(folder / "d" / "planes.npy"))

    def in_order(self, positions, planes):
        """Planes in the order of the points that were given."""
        there, here = (np.lexsort(p.T) for p in (positions, self.positions))
        if not np.array_equal(positions[there], self.positions[here]):
            raise RuntimeError("slf decode: other points than were packed")
        out = np.empty_like(planes)
        out[here] = planes[there]
        return out

    def pack(self, planes, step, transform="off"):
        """(bytes beyond the geometry, decoded planes). planes [P, K, 3] in grey levels; step in grey levels, 0: 1/64.

        transform: that of `slf pack --klt` across planes."""
        integers = np.rint(np.asarray(planes, np.float64) * UNIT).astype(np.int32)
        options = ["--step", str(max(int(round(step * UNIT)), 1)), "--predict", "on", "--klt", transform]
        size, decoded = self.run(integers, options)
        return size - self.geometry, decoded.astype(np.float32) / UNIT

    def pack_scalars(self, weights, step):
        """The same for [P, n] numbers, three to a plane."""
        points, n = weights.shape
        padded = np.zeros((points, -(-n // 3) * 3), np.float32)
        padded[:, :n] = weights
        size, decoded = self.pack(padded.reshape(points, -1, 3), step)
        return size, decoded.reshape(points, -1)[:, :n]


def to_opponent(colours):
    return colours @ OPPONENT.T.astype(np.float32)


def to_rgb(planes):
    return planes @ OPPONENT.astype(np.float32)
