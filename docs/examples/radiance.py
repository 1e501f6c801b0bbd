#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Colour of points along a direction, from the integers that `slf decode --dump DIR` writes.

    radiance.py DIR POINT X Y Z     POINT: its number; X Y Z: towards the eye, any length

Needs numpy alone and no part of slf: it evaluates the sum over the basis functions as the
specification defines them (clauses 6.3 to 6.7, B-splines after the paper's Eq. 4 to 6), slowly and plainly.
"""
import json
import math
import os
import sys
from math import comb

import numpy as np


def cardinal_bspline(order, x):
    """B-spline of degree order - 1 with knots 0, 1 .. order."""
    if x < 0 or x >= order:
        return 0.0
    if order == 1:
        return 1.0
    return (x * cardinal_bspline(order - 1, x)
            + (order - x) * cardinal_bspline(order - 1, x - 1)) / (order - 1)


def mother_wavelet(order, x):
    """Wavelet with support [0, 2 order - 1]; its two-scale taps are q_n."""
    total = 0.0
    for n in range(3 * order - 1):
        q = (-1) ** n * 2.0 ** (1 - order) * sum(
            comb(order, j) * cardinal_bspline(2 * order, n - j + 1) for j in range(order + 1))
        total += q * cardinal_bspline(order, 2 * x - n)
    return total


def wavelet(order, i, x):
    """w_i on the circle of circumference 1: the constant, then 2^k wavelets of every scale k."""
    if i == 0:
        return 1.0
    period = 2 ** (i.bit_length() - 1)
    t = (x % 1.0) * period - (i - period)
    return sum(mother_wavelet(order, t + m * period) for m in range(2 * order)
               if t + m * period < 2 * order - 1)


def basis_values(basis, theta, gamma):
    """[K] values; function k = i1 * 2^s0 + i0 is w_i0 of azimuth times w_i1 of gamma."""
    azimuth = [wavelet(basis["order"], i, theta / (2 * math.pi)) for i in range(2 ** basis["scales_theta"])]
    elevation = [wavelet(basis["order"], i, gamma / 2) for i in range(2 ** basis["scales_gamma"])]
    return np.outer(elevation, azimuth).ravel()


def harmonics(degree, x, y, z):
    """[(degree + 1)^2] real spherical harmonics of mean square 1 (clause 6.3); function l * l + l + m."""
    values = np.zeros((degree + 1) ** 2)
    cosine, sine, diagonal = 1.0, 0.0, 1.0
    for m in range(degree + 1):
        before, legendre = 0.0, diagonal
        for l in range(m, degree + 1):
            norm = (-1) ** m * math.sqrt((1 if m == 0 else 2) * (2 * l + 1) * math.factorial(l - m) / math.factorial(l + m))
            values[l * l + l + m] = norm * legendre * cosine
            if m:
                values[l * l + l - m] = norm * legendre * sine
            before, legendre = legendre, ((2 * l + 1) * z * legendre - (l + m) * before) / (l - m + 1)
        diagonal *= 2 * m + 1
        cosine, sine = cosine * x - sine * y, sine * x + cosine * y
    return values


def cells_of(positions, side):
    """Occupied cells of side^3 voxels [C, 3], and where their points are in the mean, in sixteenths of a cell (clause 6.6)."""
    cells, which, count = np.unique(positions // side, axis=0, return_inverse=True, return_counts=True)
    sums = np.stack([np.bincount(which.ravel(), axis % side) for axis in positions.T], axis=1).astype(np.int64)
    return cells, 16 * cells.astype(np.int64) + 16 * sums // count[:, None] // side


def around(cells, cell):
    """Indices of the cells within 4 of one, itself included."""
    near = np.flatnonzero(np.abs(cells - cells[cell]).max(axis=1) <= 4)
    return near[((cells[near] - cells[cell]).astype(np.int64) ** 2).sum(axis=1) <= 16]


def plane_normal(cells, places, cell):
    """Normal, of either sign, of the plane through the cells around one, in integers of length 2^17."""
    near = places[around(cells, cell)] - places[cell]
    s = len(near) * near.T @ near - np.outer(near.sum(axis=0), near.sum(axis=0))
    adjugate = np.array([np.cross(s[1], s[2]), np.cross(s[2], s[0]), np.cross(s[0], s[1])])
    best = adjugate[np.argmax(np.diag(adjugate))] if np.diag(adjugate).any() else np.array([0, 0, 1])
    bits = int(abs(best).max()).bit_length()
    w = [(abs(int(x)) << 30 >> bits) for x in best]
    length = math.isqrt(sum(x * x for x in w))
    return np.sign(best) * [(x << 17) // length for x in w]


def surface_normal(positions, voxel, side):
    """Mean of the planes' normals around a voxel's cell (clause 6.6), whatever their signs, unit length."""
    cells, places = cells_of(positions, side)
    cell = np.flatnonzero((cells == voxel // side).all(axis=1))[0]
    normals = np.array([plane_normal(cells, places, near) for near in around(cells, cell)])
    mean = (normals @ plane_normal(cells, places, cell)) @ normals
    return mean / np.linalg.norm(mean)


def weights_and_functions(directory, field, components, values):
    """Weights [R, 3] of the coded functions at a point, and these functions along a direction [R].

    values are those of the basis functions there, the first of all K. Clauses 6.7 and 8.7.5."""
    scaled = np.zeros(field["num_functions"])  # of attributes (6.8) nothing is seen
    scaled[:len(values)] = values / 2.0 ** np.array(field["shift"][:len(values)])
    weights, functions = components.astype(float), scaled[field["component_function"]]
    for transform in field["transforms"]:
        matrix = np.load(os.path.join(directory, transform["matrix"])) / 2.0 ** 14    # [R of it, S]
        if transform["joint"]:
            sys.exit("a joint transform: ask slf for planes.npy (--planes)")
        there = transform["components"]
        weights[there] = components[there] @ np.array(transform["colour"]).T / 512
        functions[there] = matrix @ scaled[transform["functions"]]
    return weights, functions


def radiance(directory, point, direction):
    """World position [3] and R, G, B [3] on 0 .. 255 of one point towards `direction`."""
    with open(os.path.join(directory, "light_field.json")) as file:
        field = json.load(file)
    positions = np.load(os.path.join(directory, "positions.npy"), mmap_mode="r")
    voxel = positions[point]
    components = np.load(os.path.join(directory, "components.npy"), mmap_mode="r")[point]
    if not field["has_basis"]:
        sys.exit("these components have no meaning: the file was packed, not encoded")
    direction = np.array(direction) / np.linalg.norm(direction)
    if field["directions"] == "reflected":
        normal = surface_normal(positions, voxel, field["normal_cell"])
        direction = 2 * (normal @ direction) * normal - direction
    x, y, z = direction
    theta = math.atan2(y, x)
    low, high = field["gamma_range"]  # directions beyond what the cameras saw repeat the last seen
    gamma = min(max(z, low), high)
    if field["basis"]["id"] == "harmonics":
        r = math.sqrt(1 - gamma * gamma)
        values = harmonics(field["basis"]["degree"], r * math.cos(theta), r * math.sin(theta), gamma)
    else:
        values = basis_values(field["basis"], theta, gamma)
    weights, functions = weights_and_functions(directory, field, components, values)
    channels = functions @ weights
    rgb = np.array(field["colour"]["to_rgb"]) @ channels
    world = np.array(field["grid"]["origin"]) + field["grid"]["step"] * voxel
    return world, np.clip(rgb, 0, 255)


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    world, rgb = radiance(sys.argv[1], int(sys.argv[2]), [float(a) for a in sys.argv[3:]])
    print("%.10g %.10g %.10g  %.3f %.3f %.3f" % (*world, *rgb))


if __name__ == "__main__":
    main()
