# SPDX-License-Identifier: Apache-2.0
"""Pictures against a capture's photographs, by the definition of spec annex D that `slf eval` has.

For what `slf eval` does not read. Captures are those of cameras.json with a cloud that has normals; the masks of
photographs without alpha come from its points, by the discs and the coverage of annex E. On pictures that
`slf render` drew the figures are those of `slf eval` (tests/test_splats.py).
"""
import json
import pathlib

import matplotlib.image
import numpy as np
from scipy.ndimage import correlate1d
from scipy.spatial import cKDTree

from tmc3 import read_ply

LUMA = np.array([0.2126, 0.7152, 0.0722])
NOTHING = np.array([128, 128, 128])  # behind photographs that have an alpha channel
COVERED = 128                        # of 255: from there on a pixel shows the object
SPACING_SAMPLES = 2000
# Annex E.
FILTER, CORE, BAND, STEEPEST, FLATTEST, SPACING_REACH = 1.0, 0.4, 0.8, 0.3, 0.1, 1.38
DISC_SHARE, GAIN, OFFSET, EXPONENT = 0.85, 2, 0.5, 4
MOST_CHANGE, LARGEST = 0.75, 512
# SSIM.
WINDOW = np.exp(-np.arange(-5, 6) ** 2 / (2 * 1.5 ** 2))
SSIM_C1, SSIM_C2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2


class NotJudged(ValueError):
    """The capture is of a kind that this module does not know; str() says which."""


class Capture:
    """Cameras, photographs and the surface that the masks come from."""

    def __init__(self, directory, points=None):
        self.directory = pathlib.Path(directory)
        path = self.directory / "cameras.json"
        if not path.is_file():
            raise NotJudged(f"{directory}: no cameras.json: other layouts are for slf eval alone")
        described = json.loads(path.read_text(encoding="utf-8"))
        self.cameras = {camera["image"]: camera for camera in described["cameras"]}
        if any("mask" in camera for camera in self.cameras.values()):
            raise NotJudged(f"{directory}: masks are for slf eval alone")
        splits, names = described.get("splits") or {}, list(self.cameras)
        self.held_out = splits.get("evaluation") or names[3::4]
        cloud = pathlib.Path(points) if points else self.directory / "points.ply"
        if not cloud.is_file():
            raise NotJudged(f"{cloud}: is not there: the masks come from points")
        ply = read_ply(cloud)
        if "nx" not in ply:
            raise NotJudged(f"{cloud}: has no normals: slf eval estimates them, this does not")
        self.positions = np.stack([ply[a] for a in "xyz"], 1).astype(np.float64)
        self.normals = np.stack([ply[a] for a in ("nx", "ny", "nz")], 1).astype(np.float64)
        self.spacing = typical_spacing(self.positions)

    def photograph(self, name):
        """(RGB over the background [height, width, 3], object [height, width], background [3]), 8 bit."""
        values = matplotlib.image.imread(self.directory / name)
        values = np.round(255 * values).astype(int) if values.dtype.kind == "f" else values.astype(int)
        values = values if values.ndim == 3 else np.repeat(values[..., None], 3, 2)
        if values.shape[2] == 4:
            alpha = values[..., 3:]
            return blended(values[..., :3], NOTHING, alpha), alpha[..., 0] >= COVERED, NOTHING
        shown = surface_coverage(self, self.cameras[name]) >= 0.5
        return values, shown, border(values, shown)


def typical_spacing(positions):
    """Mean distance to the fourth neighbour, of some points."""
    some = positions[::max(len(positions) // SPACING_SAMPLES, 1)]
    return float(cKDTree(positions).query(some, 5)[0][:, 4].mean())


def blended(a, b, alpha):
    """a over b by alpha 0 .. 255, whole numbers."""
    return (a * alpha + b * (255 - alpha) + 127) // 255


def border(photograph, shown):
    """The colour that stands behind the object: the median of the edge where it does not show, channel by channel."""
    edge = np.zeros(shown.shape, bool)
    edge[[0, -1]] = edge[:, [0, -1]] = True
    free = edge & ~shown
    values = photograph[free if free.any() else edge]
    return np.sort(values, axis=0)[len(values) // 2]


# The surface of the cloud in a picture.

def discs(capture, camera):
    """Points as ellipses that touch the picture: a dict of arrays. E.3."""
    rotation, k = np.array(camera["R"], float), np.array(camera["K"], float)
    at = capture.positions @ rotation.T + np.array(camera["t"], float)
    radius, spacing = capture.spacing, capture.spacing
    chosen = at[:, 2] > radius
    p, n = at[chosen], capture.normals[chosen] @ rotation.T
    to_eye = -p / np.linalg.norm(p, axis=1, keepdims=True)
    n = facing(n, to_eye)
    cosine = (n * to_eye).sum(1)
    x, y, z = p.T
    zero = np.zeros_like(z)
    ju = np.stack([k[0, 0] / z, zero, -k[0, 0] * x / z ** 2], 1)
    jv = np.stack([zero, k[1, 1] / z, -k[1, 1] * y / z ** 2], 1)
    nu, nv = (ju * n).sum(1), (jv * n).sum(1)
    uu, uv, vv = (radius ** 2 * s for s in ((ju * ju).sum(1) - nu * nu, (ju * jv).sum(1) - nu * nv, (jv * jv).sum(1) - nv * nv))
    disc_determinant, uu, vv = uu * vv - uv * uv, uu + FILTER ** 2, vv + FILTER ** 2
    determinant = uu * vv - uv * uv
    plane = (n * p).sum(1)
    du, dv = n[:, 0] / (plane * k[0, 0]), n[:, 1] / (plane * k[1, 1])
    change = np.sqrt(np.maximum(du * du * uu + 2 * du * dv * uv + dv * dv * vv, 1e-300))
    tame = np.minimum(1, MOST_CHANGE / (z * change))
    band = BAND * np.sqrt(spacing ** 2 + (FILTER * z / k[0, 0]) ** 2) / np.maximum(cosine, STEEPEST)
    own = {"u": k[0, 0] * x / z + k[0, 2], "v": k[1, 1] * y / z + k[1, 2], "a": vv / determinant, "b": -uv / determinant,
           "c": uu / determinant, "half_width": np.sqrt(uu), "half_height": np.sqrt(vv), "inverse": 1 / z, "du": tame * du, "dv": tame * dv,
           "fade": z * z / band, "weight": np.sqrt(np.maximum(disc_determinant / determinant, 1e-9)) / SPACING_REACH ** 2}
    seen = (own["half_width"] < LARGEST) & (own["half_height"] < LARGEST)
    for at_, half, size in (("u", "half_width", camera["width"]), ("v", "half_height", camera["height"])):
        seen &= (own[at_] + own[half] > 0) & (own[at_] - own[half] < size)
    return {name: values[seen] for name, values in own.items()}


def facing(normals, to_eye):
    """Normals turned to the eye, at least FLATTEST towards it."""
    cosine = (normals * to_eye).sum(1, keepdims=True)
    sign = np.where(cosine < 0, -1, 1)
    cosine = np.abs(cosine)
    flat = np.sqrt(1 - FLATTEST ** 2) / np.sqrt(np.maximum(1 - cosine ** 2, 1e-12)) * (sign * normals - cosine * to_eye) + FLATTEST * to_eye
    out = np.where(cosine >= FLATTEST, sign * normals, flat)
    return np.where((normals ** 2).sum(1, keepdims=True) > 0.5, out, to_eye)


def pixels_of(own, width, height):
    """(disc, pixel, du, dv, r^2) of all pixel centres within an ellipse."""
    low_u, low_v = np.floor(own["u"] - own["half_width"]).astype(int), np.floor(own["v"] - own["half_height"]).astype(int)
    parts = []
    for step_v in range(int(2 * own["half_height"].max(initial=0)) + 2):
        for step_u in range(int(2 * own["half_width"].max(initial=0)) + 2):
            near = np.flatnonzero((step_u <= 2 * own["half_width"] + 1) & (step_v <= 2 * own["half_height"] + 1))
            column, row = low_u[near] + step_u, low_v[near] + step_v
            du, dv = column + 0.5 - own["u"][near], row + 0.5 - own["v"][near]
            r2 = du * (own["a"][near] * du + 2 * own["b"][near] * dv) + own["c"][near] * dv * dv
            inside = (r2 < 1) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
            parts.append((near[inside], (row * width + column)[inside], du[inside], dv[inside], r2[inside]))
    return [np.concatenate(column) for column in zip(*parts)]


def surface_coverage(capture, camera):
    """[height, width] 0 .. 1: how much of a pixel the capture's points cover. E.4, E.5."""
    width, height = camera["width"], camera["height"]
    own = discs(capture, camera)
    disc, pixel, du, dv, r2 = pixels_of(own, width, height)
    a, b, c = (own[name][disc] for name in "abc")
    inverse = own["inverse"][disc] + own["du"][disc] * du + own["dv"][disc] * dv
    nearest = np.zeros(width * height)
    core = r2 < CORE
    np.maximum.at(nearest, pixel[core], inverse[core])
    near = np.clip(1 - np.maximum(0, (nearest[pixel] - inverse) * own["fade"][disc]), 0, None)
    weight = np.bincount(pixel, own["weight"][disc] * (1 - r2) ** EXPONENT * near ** 2, width * height)
    coverage = np.clip(GAIN * (EXPONENT + 1) / np.pi * weight - OFFSET, 0, 1)
    np.maximum.at(coverage, pixel, share_of_disc(a, b, c, du, dv, r2))
    coverage[weight == 0] = 0
    return np.minimum(coverage, 1).reshape(height, width)


def share_of_disc(a, b, c, du, dv, r2):
    """Share of a pixel that a disc covers, by the distance to its edge."""
    minor = 1 / ((a + c) / 2 + np.sqrt(((a - c) / 2) ** 2 + b * b))
    inner = np.maximum(0, (DISC_SHARE * np.sqrt(np.maximum(0, minor - FILTER ** 2)) - 0.5) / np.sqrt(minor))
    at_centre = 0.5 + DISC_SHARE * np.sqrt(np.maximum(0, 1 / np.maximum(a, c) - FILTER ** 2))
    square = np.maximum(du * du + dv * dv, 1e-30)
    slope = np.sqrt(square * ((a * du + b * dv) ** 2 + (b * du + c * dv) ** 2))
    reach = np.sqrt(np.maximum(0, square / np.maximum(r2, 1e-30) - FILTER ** 2))
    share = np.where(r2 > inner ** 2, 0.5 + (DISC_SHARE * reach - np.sqrt(square)) * r2 / slope, 1)
    return np.minimum(np.where(square < 1e-4, at_centre, share), 1)


# Errors.

def ssim_sum(a, b, mask):
    """(sum over the pixels of a mask, their number), windows seeing no others."""
    def blur(values):
        return correlate1d(correlate1d(values, WINDOW, 1, mode="constant"), WINDOW, 0, mode="constant")
    a, b = np.where(mask, a, 0.0), np.where(mask, b, 0.0)
    scale = 1 / np.where(mask, blur(mask.astype(float)), 1)
    mean_a, mean_b, aa, bb, ab = (blur(values) * scale for values in (a, b, a * a, b * b, a * b))
    similar = (2 * mean_a * mean_b + SSIM_C1) / (mean_a ** 2 + mean_b ** 2 + SSIM_C1) * \
        (2 * (ab - mean_a * mean_b) + SSIM_C2) / (aa - mean_a ** 2 + bb - mean_b ** 2 + SSIM_C2)
    return similar[mask].sum(), int(mask.sum())


class Quality:
    """Errors of pictures, pooled."""

    def __init__(self):
        self.sums = {"inside": np.zeros(4), "all": np.zeros(4)}  # squares, pixels, similarity, pixels
        self.object_pixels, self.pictures = 0, 0

    def add(self, photograph, shown, background, picture, coverage):
        """picture: [height, width, 3] over black, coverage: [height, width], both 8 bit."""
        rendering = np.minimum(picture.astype(int) + blended(0, background, coverage.astype(int)[..., None]), 255)
        squares = ((rendering - photograph) ** 2).sum(2)
        was, is_ = (values @ LUMA for values in (photograph, rendering))
        for name, mask in (("inside", shown & (coverage >= COVERED)), ("all", np.ones(shown.shape, bool))):
            self.sums[name] += [squares[mask].sum(), mask.sum(), *ssim_sum(was, is_, mask)]
        self.object_pixels += int(shown.sum())
        self.pictures += 1

    def include(self, other):
        for name, own in self.sums.items():
            own += other.sums[name]
        self.object_pixels += other.object_pixels
        self.pictures += other.pictures

    def report(self):
        """Keys as `slf eval --json` has them for held-out images."""
        out = {"cameras": self.pictures, "coverage": self.sums["inside"][1] / max(self.object_pixels, 1)}
        for name, (squares, pixels, similarity, _) in self.sums.items():
            with np.errstate(divide="ignore"):
                psnr = 10 * np.log10(255 ** 2 * 3 * max(pixels, 1) / squares) if pixels else float("nan")
            out[name] = {"psnr": float(psnr), "ssim": float(similarity / max(pixels, 1))}
        return out


def to_bytes(values):
    """0 .. 1 to 0 .. 255."""
    return np.floor(255 * np.clip(values, 0, 1) + 0.5).astype(np.uint8)
