# SPDX-License-Identifier: Apache-2.0
"""What cameras see of the points of a decoded file: the points x directions x colours that every codec of this folder is given.

The definition is that of `slf eval` (spec annex D, paper III-A): a point is seen where its normal is within 80 degrees of the
camera, it projects into the picture and the depth buffer of the capture's points does not hide it; its colour is sampled
bilinearly. Captures are those of cameras.json with normals and opaque photographs."""
import json
import pathlib

import matplotlib.image
import numpy as np
from scipy.spatial import cKDTree

from judge import typical_spacing
from tmc3 import read_ply

LEAST_COSINE = np.sin(np.radians(10))
TOLERANCE = 2.5   # hidden if deeper by more, in spacings over the cosine
HELD_OUT_EVERY = 4


class Camera:
    def __init__(self, described, directory):
        self.name, self.width, self.height = described["image"], described["width"], described["height"]
        self.k, self.rotation, self.translation = (np.array(described[key], float) for key in ("K", "R", "t"))
        self.centre = -self.rotation.T @ self.translation
        self.path = pathlib.Path(directory, self.name)

    def project(self, world):
        """(u, v, depth) of world positions."""
        x, y, z = (world @ self.rotation.T + self.translation).T
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.k[0, 0] * x / z + self.k[0, 2], self.k[1, 1] * y / z + self.k[1, 2], z

    def photograph(self):
        """[height, width, 3] 0 .. 255."""
        values = matplotlib.image.imread(self.path)
        if values.ndim == 3 and values.shape[2] == 4 and (values[..., 3] == values.dtype.type(1 if values.dtype.kind == "f" else 255)).all():
            values = values[..., :3]
        if values.ndim != 3 or values.shape[2] != 3:
            raise ValueError(f"{self.path}: opaque RGB alone is read here")
        return np.round(255 * values).astype(np.uint8) if values.dtype.kind == "f" else values


class DepthBuffer:
    """Nearest depth of points that are squares of one spacing either way."""

    def __init__(self, camera, occluders, spacing):
        self.camera, self.spacing, self.focal = camera, spacing, max(camera.k[0, 0], camera.k[1, 1])
        u, v, z = camera.project(occluders)
        front = z > 0
        u, v, z = u[front], v[front], z[front]
        half = np.maximum(0.5, spacing * self.focal / z)
        left, right = (np.clip(np.floor(u + s * half + 0.5), 0, camera.width).astype(int) for s in (-1, 1))
        top, end = (np.clip(np.floor(v + s * half + 0.5), 0, camera.height).astype(int) for s in (-1, 1))
        nearest = np.full(camera.width * camera.height, np.inf, np.float32)
        for dy in range(int((end - top).max(initial=0))):
            for dx in range(int((right - left).max(initial=0))):
                inside = (left + dx < right) & (top + dy < end)
                np.minimum.at(nearest, ((top + dy) * camera.width + left + dx)[inside], z[inside].astype(np.float32))
        self.nearest = nearest.reshape(camera.height, camera.width)

    def hides(self, u, v, depth, cosine):
        """For image points inside the picture."""
        nearest = self.nearest[v.astype(int), u.astype(int)]
        reach = np.maximum(self.spacing, depth / self.focal)
        return depth - nearest > TOLERANCE * reach / np.maximum(cosine, 1e-3)


def bilinear(picture, u, v):
    """Colours at image points; pixel centres at + 0.5, edges repeated."""
    height, width = picture.shape[:2]
    x, y = u - 0.5, v - 0.5
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    wx, wy = (x - x0)[:, None].astype(np.float32), (y - y0)[:, None].astype(np.float32)
    columns, rows = [np.clip(x0 + i, 0, width - 1) for i in (0, 1)], [np.clip(y0 + i, 0, height - 1) for i in (0, 1)]
    upper, lower = ((1 - wx) * picture[row, columns[0]] + wx * picture[row, columns[1]] for row in rows)
    return (1 - wy) * upper + wy * lower


class Observations:
    """Sorted by point, then camera. point, camera [O]; direction [O, 3] unit, world, to the camera; place [O, 2] in the
    picture; colour [O, 3] 0 .. 255."""

    def __init__(self, point, camera, direction, place, colour):
        order = np.argsort(point, kind="stable")
        self.point, self.camera, self.direction = point[order], camera[order], direction[order]
        self.place, self.colour = place[order], colour[order]

    def __len__(self):
        return len(self.point)

    def psnr(self, colours):
        """Spec annex D: radiance clamped and rounded, against 8-bit colours, one mean."""
        there, here = (np.floor(np.clip(c, 0, 255) + 0.5) for c in (self.colour, colours))
        error = ((there - here) ** 2).mean(dtype=np.float64)
        return float(10 * np.log10(255 ** 2 / max(error, 1e-12)))

    def with_colours(self, pictures):
        """Itself, as seen in other pictures: number of a camera to [height, width, 3]."""
        colour = np.empty_like(self.colour)
        for camera, picture in pictures.items():
            mine = self.camera == camera
            colour[mine] = bilinear(picture, *self.place[mine].T)
        return Observations(self.point, self.camera, self.direction, self.place, colour)


class Scene:
    """Points of a decoded file (positions [P, 3] on the grid, Morton order as `slf decode --dump` gives them) before the
    cameras of a capture. Normals are those of the capture's nearest points: a gift to all codecs of this folder."""

    def __init__(self, directory, positions, origin, step, points=None):
        directory = pathlib.Path(directory)
        described = json.loads((directory / "cameras.json").read_text(encoding="utf-8"))
        self.cameras = [Camera(c, directory) for c in described["cameras"]]
        names, splits = [c.name for c in self.cameras], described.get("splits") or {}
        held_out = splits.get("evaluation") or names[HELD_OUT_EVERY - 1::HELD_OUT_EVERY]
        fitted = splits.get("dense") or [n for n in names if n not in held_out]
        self.fitted_cameras, self.held_out_cameras = ([names.index(n) for n in some] for some in (fitted, held_out))
        cloud = read_ply(points or directory / "points.ply")
        captured, normals = (np.stack([cloud[a] for a in axes], 1).astype(np.float64) for axes in ("xyz", ("nx", "ny", "nz")))
        self.positions = np.asarray(positions, np.int64)
        self.world = (np.array(origin) + step * self.positions).astype(np.float32).astype(np.float64)
        self.normals = normals[cKDTree(captured).query(self.world)[1]]
        self.occluders, self.spacing, self.step = captured, typical_spacing(captured), step
        self.buffers = {}
        self.fitted, self.held_out = self.observe(self.fitted_cameras), self.observe(self.held_out_cameras)

    def observe(self, cameras):
        parts = []
        for number in cameras:
            camera = self.cameras[number]
            direction = camera.centre - self.world
            direction /= np.linalg.norm(direction, axis=1, keepdims=True)
            cosine = (direction * self.normals).sum(1)
            u, v, depth = camera.project(self.world)
            p = np.flatnonzero((cosine >= LEAST_COSINE) & (depth > 0) & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height))
            self.buffers[number] = DepthBuffer(camera, self.occluders, self.spacing)
            p = p[~self.buffers[number].hides(u[p], v[p], depth[p], cosine[p])]
            parts.append((p.astype(np.int32), np.full(len(p), number, np.int16), direction[p].astype(np.float32),
                          np.stack([u[p], v[p]], 1), bilinear(camera.photograph(), u[p], v[p])))
        return Observations(*(np.concatenate(column) for column in zip(*parts)))
