# SPDX-License-Identifier: Apache-2.0
"""A capture that tests of the related codecs draw: a ball with a texture and a highlight, and a packer that is no program."""
import json

import matplotlib.image
import numpy as np

from entropy import bits_of

RADIUS, SIDE, FOCAL, DISTANCE = 7.0, 48, 100.0, 40.0


def shaded(at, centre):
    """Colour of the ball's point `at` (a normal times RADIUS) seen from `centre`; whole numbers."""
    n = at / RADIUS
    eye = centre - at
    eye = eye / np.linalg.norm(eye, axis=-1, keepdims=True)
    mirrored = 2 * (n * eye).sum(-1, keepdims=True) * n - eye
    shine = 70 * np.maximum(mirrored[..., 2:], 0) ** 4
    return 90 + 50 * np.sin(0.4 * at) + shine


def camera(number, count):
    """(rotation, translation, centre): on a spiral, looking at the middle."""
    z = 0.7 * (2 * (number + 0.5) / count - 1)
    angle = 2.4 * number
    centre = DISTANCE * np.array([np.cos(angle) * np.sqrt(1 - z * z), np.sin(angle) * np.sqrt(1 - z * z), z])
    forward = -centre / np.linalg.norm(centre)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    return rotation, -rotation @ centre, centre


def photograph(rotation, centre):
    v, u = np.mgrid[:SIDE, :SIDE] + 0.5
    rays = np.stack([(u - SIDE / 2) / FOCAL, (v - SIDE / 2) / FOCAL, np.ones_like(u)], -1) @ rotation
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    b = rays @ centre
    root = b * b - (centre @ centre - RADIUS ** 2)
    hit = root > 0
    picture = np.full((SIDE, SIDE, 3), 128.0)
    picture[hit] = shaded(centre - (b + np.sqrt(np.maximum(root, 0)))[hit][:, None] * rays[hit], centre)
    return np.clip(np.round(picture), 0, 255).astype(np.uint8)


def write_capture(folder, count=28):
    """Cameras, photographs and points with normals; returns (positions on the grid, origin, step)."""
    cameras = []
    (folder / "images").mkdir()
    for number in range(count):
        rotation, translation, centre = camera(number, count)
        name = f"images/{number:04}.png"
        matplotlib.image.imsave(folder / name, photograph(rotation, centre))
        cameras.append({"image": name, "width": SIDE, "height": SIDE, "K": [[FOCAL, 0, SIDE / 2], [0, FOCAL, SIDE / 2], [0, 0, 1]],
                        "R": rotation.tolist(), "t": translation.tolist()})
    (folder / "cameras.json").write_text(json.dumps({"cameras": cameras}), encoding="utf-8")
    grid = np.array(list(np.ndindex(17, 17, 17))) - 8
    shell = grid[np.abs(np.linalg.norm(grid, axis=1) - RADIUS) < 0.5]
    rows = np.zeros(len(shell), [(a, "<f4") for a in ("x", "y", "z", "nx", "ny", "nz")])
    normals = shell / np.linalg.norm(shell, axis=1, keepdims=True)
    for i, axis in enumerate("xyz"):
        rows[axis], rows["n" + axis] = shell[:, i], normals[:, i]
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
    header += "".join(f"property float {name}\n" for name in rows.dtype.names) + "end_header\n"
    (folder / "points.ply").write_bytes(header.encode() + rows.tobytes())
    return shell + 8, [-8, -8, -8], 1.0


class Rounder:
    """In place of planes.Packer: rounds to the step, and counts bits point by point."""
    geometry = 100

    def pack(self, planes, step, transform="off"):
        step = max(step, 1 / 64)
        integers = np.rint(np.asarray(planes, float) / step).astype(int)
        return bits_of(integers, np.zeros(integers.shape, int)) / 8, (integers * step).astype(np.float32)

    def pack_scalars(self, weights, step):
        return self.pack(weights, step)
