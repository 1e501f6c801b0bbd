# SPDX-License-Identifier: Apache-2.0
"""Gaussian splats (Kerbl et al. 2023) from their PLY to pictures, in numpy.

The rasteriser has the steps and constants of the reference implementation, so that splats trained elsewhere
look as they were trained. 4,000 splats at 320 x 320 take about half a second.
"""
import dataclasses

import numpy as np

from tmc3 import read_ply

TILE = 16
NEAR = 0.2             # depth in front of which a splat is left out, world units
FRUSTUM_SHARE = 1.3    # of the tangent of half a picture, where the derivative of the projection is clamped
BLUR = 0.3             # added to the variance along both axes, pixels squared
REACH = 3              # standard deviations
MOST_OPAQUE, LEAST_OPAQUE, LEAST_CLEAR = 0.99, 1 / 255, 1e-4
# Real harmonics by degree, of the unit vector from the eye to the splat.
C0, C1 = 0.28209479177387814, 0.4886025119029199
C2 = (1.0925484305920792, -1.0925484305920792, 0.31539156525252005, -1.0925484305920792, 0.5462742152960396)
C3 = (-0.5900435899266435, 2.890611442640554, -0.4570457994644658, 0.3731763325901154, -0.4570457994644658,
      1.445305721320277, -0.5900435899266435)


@dataclasses.dataclass
class Splats:
    positions: np.ndarray   # [S, 3]
    covariances: np.ndarray  # [S, 3, 3]
    opacities: np.ndarray   # [S] 0 .. 1
    harmonics: np.ndarray   # [S, K, 3], K = 1, 4, 9 or 16


def read_splats(path):
    """ValueError where the PLY is none of splats."""
    ply = read_ply(path)
    rest = sum(name.startswith("f_rest_") for name in ply)
    wanted = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4)),
              *(f"f_rest_{i}" for i in range(rest))]
    if missing := [name for name in wanted if name not in ply]:
        raise ValueError(f"{path}: no {missing[0]}: not a PLY of splats")
    if rest not in (0, 9, 24, 45):
        raise ValueError(f"{path}: {rest} properties f_rest_: 0, 9, 24 or 45 are expected")

    def columns(*names):
        return np.stack([ply[name] for name in names], 1).astype(np.float64)
    w, x, y, z = (lambda q: q / np.linalg.norm(q, axis=1, keepdims=True))(columns(*(f"rot_{i}" for i in range(4)))).T
    turn = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                     2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1).reshape(-1, 3, 3)
    axes = turn * np.exp(columns("scale_0", "scale_1", "scale_2"))[:, None]
    harmonics = columns("f_dc_0", "f_dc_1", "f_dc_2")[:, None]
    if rest:  # channel by channel
        own = columns(*(f"f_rest_{i}" for i in range(rest))).reshape(len(axes), 3, -1)
        harmonics = np.concatenate([harmonics, own.transpose(0, 2, 1)], 1)
    return Splats(columns("x", "y", "z"), axes @ axes.transpose(0, 2, 1), 1 / (1 + np.exp(-columns("opacity")[:, 0])), harmonics)


def harmonic_values(directions, count):
    """[S, count] of unit directions [S, 3]."""
    x, y, z = directions.T
    values = [np.full_like(x, C0), -C1 * y, C1 * z, -C1 * x]
    if count > 4:
        values += [C2[0] * x * y, C2[1] * y * z, C2[2] * (2 * z * z - x * x - y * y), C2[3] * x * z, C2[4] * (x * x - y * y)]
    if count > 9:
        values += [C3[0] * y * (3 * x * x - y * y), C3[1] * x * y * z, C3[2] * y * (4 * z * z - x * x - y * y),
                   C3[3] * z * (2 * z * z - 3 * x * x - 3 * y * y), C3[4] * x * (4 * z * z - x * x - y * y),
                   C3[5] * z * (x * x - y * y), C3[6] * x * (x * x - 3 * y * y)]
    return np.stack(values[:count], 1)


def project(splats, camera):
    """(indices that may show, by depth; means [S, 2] in pixels; covariances [S, 2, 2] in pixels squared) of those."""
    rotation, k = np.array(camera["R"], float), np.array(camera["K"], float)
    at = splats.positions @ rotation.T + np.array(camera["t"], float)
    chosen = np.flatnonzero(at[:, 2] > NEAR)
    chosen = chosen[np.argsort(at[chosen, 2], kind="stable")]
    x, y, z = at[chosen].T
    limit_x, limit_y = (FRUSTUM_SHARE * camera[side] / (2 * k[i, i]) for i, side in enumerate(("width", "height")))
    clamped_x, clamped_y = np.clip(x / z, -limit_x, limit_x), np.clip(y / z, -limit_y, limit_y)
    zero = np.zeros_like(z)
    jacobian = np.stack([np.stack([k[0, 0] / z, zero, -k[0, 0] * clamped_x / z], 1),
                         np.stack([zero, k[1, 1] / z, -k[1, 1] * clamped_y / z], 1)], 1) @ rotation
    spread = jacobian @ splats.covariances[chosen] @ jacobian.transpose(0, 2, 1) + BLUR * np.eye(2)
    return chosen, np.stack([k[0, 0] * x / z + k[0, 2], k[1, 1] * y / z + k[1, 2]], 1), spread


def tiles_of(means, spread, width, height):
    """(rank of a splat, tile) of all pairs that touch, by tile and within it by rank."""
    middle = (spread[:, 0, 0] + spread[:, 1, 1]) / 2
    determinant = spread[:, 0, 0] * spread[:, 1, 1] - spread[:, 0, 1] ** 2
    radius = np.ceil(REACH * np.sqrt(middle + np.sqrt(np.maximum(0.1, middle ** 2 - determinant))))[:, None]
    counts = np.array([-(-width // TILE), -(-height // TILE)])
    corner = means - 0.5  # of the reference, whose pixel centres are whole numbers
    low = np.clip((corner - radius) // TILE, 0, counts).astype(int)
    high = np.clip((corner + radius + TILE - 1) // TILE, 0, counts).astype(int)
    across, down = (high - low).T
    pairs = across * down
    rank = np.repeat(np.arange(len(pairs)), pairs)
    number = np.arange(len(rank)) - np.repeat(np.cumsum(pairs) - pairs, pairs)
    tile = (low[rank, 1] + number // across[rank]) * counts[0] + low[rank, 0] + number % across[rank]
    order = np.argsort(tile, kind="stable")
    return rank[order], tile[order]


def blend(centres, means, conics, opacities, colours):
    """(colours [P, 3], what is left of the background [P]) of pixel centres [P, 2] behind splats, nearest first."""
    offset = centres[:, None] - means
    dx, dy = offset[..., 0], offset[..., 1]
    power = -0.5 * (conics[:, 0] * dx * dx + conics[:, 2] * dy * dy) - conics[:, 1] * dx * dy
    alpha = np.minimum(MOST_OPAQUE, opacities * np.exp(np.minimum(power, 0)))
    alpha[alpha < LEAST_OPAQUE] = 0
    after = np.cumprod(1 - alpha, axis=1)
    over = after < LEAST_CLEAR  # from there on nothing is drawn
    before = np.concatenate([np.ones((len(after), 1), np.float32), after[:, :-1]], 1)
    return np.where(over, 0, before * alpha) @ colours, np.where(over, 1, after).min(1)


def render(splats, camera):
    """(colours [height, width, 3] over black, 0 .. 1 and more; coverage [height, width]) as a camera sees them."""
    width, height = camera["width"], camera["height"]
    chosen, means, spread = project(splats, camera)
    eye = -np.array(camera["R"], float).T @ np.array(camera["t"], float)
    directions = splats.positions[chosen] - eye
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    values = harmonic_values(directions, splats.harmonics.shape[1])
    colours = np.maximum(np.einsum("sk,skc->sc", values, splats.harmonics[chosen]) + 0.5, 0).astype(np.float32)
    determinant = spread[:, 0, 0] * spread[:, 1, 1] - spread[:, 0, 1] ** 2
    conics = (np.stack([spread[:, 1, 1], -spread[:, 0, 1], spread[:, 0, 0]], 1) / determinant[:, None]).astype(np.float32)
    opacities = splats.opacities[chosen].astype(np.float32)
    rank, tile = tiles_of(means, spread, width, height)
    picture, clear = np.zeros((height, width, 3), np.float32), np.ones((height, width), np.float32)
    tiles, first = np.unique(tile, return_index=True)
    for number, begin, end in zip(tiles, first, [*first[1:], len(tile)]):
        top, left = TILE * (number // -(-width // TILE)), TILE * (number % -(-width // TILE))
        bottom, right = min(top + TILE, height), min(left + TILE, width)
        v, u = np.mgrid[top:bottom, left:right] + 0.5
        origin = np.array([left, top])  # so that single precision will do
        own = rank[begin:end]
        drawn, rest = blend(np.stack([u.ravel(), v.ravel()], 1).astype(np.float32) - origin.astype(np.float32),
                            (means[own] - origin).astype(np.float32), conics[own], opacities[own], colours[own])
        picture[top:bottom, left:right] = drawn.reshape(bottom - top, right - left, 3)
        clear[top:bottom, left:right] = rest.reshape(bottom - top, right - left)
    return picture, 1 - clear
