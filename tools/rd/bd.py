#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""BD-rate and BD-PSNR of two rate-distortion curves.

    bd.py ANCHOR.csv TEST.csv [--akima]     two columns each: bytes, PSNR in dB; no header

BD-rate: mean difference in rate at equal PSNR, percent of the anchor's rate; negative: TEST needs
less. BD-PSNR: mean difference in PSNR at equal rate, dB. Both interpolate log rate against PSNR by
piecewise cubic Hermite polynomials (PCHIP), as the JCT-VC and JVET common test conditions do
(JCTVC-L1100, JVET-T2010); Akima is the second opinion (Herglotz et al., arXiv 2202.12565).
Source of the measure: G. Bjontegaard, VCEG-M33, 2001.
"""
import csv
import sys

import numpy as np
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

INTERPOLATORS = {"pchip": PchipInterpolator, "akima": Akima1DInterpolator}
LEAST_POINTS = 4
LEAST_OVERLAP = 0.25  # of the smaller PSNR range; below it a mean over the overlap says nothing


class NoFigure(ValueError):
    """There is no BD figure of these curves; str() is the reason."""


def _sorted(name, rates, psnrs):
    """Log10 rates and PSNRs, both strictly ascending."""
    rates, psnrs = np.asarray(rates, float), np.asarray(psnrs, float)
    if rates.shape != psnrs.shape or rates.ndim != 1:
        raise NoFigure(f"{name}: {rates.size} rates but {psnrs.size} PSNRs")
    if rates.size < LEAST_POINTS:
        raise NoFigure(f"{name} has {rates.size} points, {LEAST_POINTS} are needed")
    if not (np.isfinite(rates).all() and np.isfinite(psnrs).all()):
        raise NoFigure(f"{name} holds a value that is not a finite number")
    if (rates <= 0).any():
        raise NoFigure(f"{name} holds a rate that is not positive")
    order = np.argsort(rates)
    rates, psnrs = rates[order], psnrs[order]
    if (np.diff(rates) <= 0).any():
        raise NoFigure(f"{name} is not monotone: the rate {rates[np.argmin(np.diff(rates))]:g} occurs twice")
    falls = np.flatnonzero(np.diff(psnrs) <= 0)
    if falls.size:
        i = falls[0]
        raise NoFigure(f"{name} is not monotone: {psnrs[i]:.3f} dB at {rates[i]:g}, {psnrs[i + 1]:.3f} dB at {rates[i + 1]:g}")
    return np.log10(rates), psnrs


def _mean_difference(x1, y1, x2, y2, method):
    """Mean of y2 - y1 over the x that both curves have."""
    low, high = max(x1[0], x2[0]), min(x1[-1], x2[-1])
    make = INTERPOLATORS[method]
    first, second = make(x1, y1), make(x2, y2)
    return (second.integrate(low, high) - first.integrate(low, high)) / (high - low)


def _check_overlap(name, unit, x1, x2):
    overlap = min(x1[-1], x2[-1]) - max(x1[0], x2[0])
    smaller = min(x1[-1] - x1[0], x2[-1] - x2[0])
    if overlap < LEAST_OVERLAP * smaller:
        raise NoFigure(f"{name} {x1[0]:.2f} to {x1[-1]:.2f} and {x2[0]:.2f} to {x2[-1]:.2f} {unit} overlap by "
                       f"{100 * max(overlap, 0) / smaller:.0f} % of the smaller, "
                       f"{100 * LEAST_OVERLAP:.0f} % are needed")


def bd_rate(anchor_rates, anchor_psnrs, rates, psnrs, method="pchip"):
    """Percent; NoFigure where there is none. Rates in any one unit, points in any order."""
    r1, p1 = _sorted("the anchor", anchor_rates, anchor_psnrs)
    r2, p2 = _sorted("the test", rates, psnrs)
    _check_overlap("PSNR ranges", "dB", p1, p2)
    return 100 * float(10 ** _mean_difference(p1, r1, p2, r2, method) - 1)


def bd_psnr(anchor_rates, anchor_psnrs, rates, psnrs, method="pchip"):
    """dB; NoFigure where there is none."""
    r1, p1 = _sorted("the anchor", anchor_rates, anchor_psnrs)
    r2, p2 = _sorted("the test", rates, psnrs)
    _check_overlap("log10 rate ranges", "", r1, r2)
    return float(_mean_difference(r1, p1, r2, p2, method))


def _read(path):
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(file) if row]
    try:
        return [float(row[0]) for row in rows], [float(row[1]) for row in rows]
    except (ValueError, IndexError):
        sys.exit(f"bd.py: {path}: not two columns of numbers")


def main(arguments):
    method = "akima" if "--akima" in arguments else "pchip"
    files = [a for a in arguments if a != "--akima"]
    if len(files) != 2:
        sys.exit(__doc__)
    curves = _read(files[0]) + _read(files[1])
    for name, unit, measure in (("BD-rate", "%", bd_rate), ("BD-PSNR", "dB", bd_psnr)):
        try:
            print(f"{name} {measure(*curves, method):+.4f} {unit}")
        except NoFigure as reason:
            print(f"{name} none: {reason}")


if __name__ == "__main__":
    main(sys.argv[1:])
