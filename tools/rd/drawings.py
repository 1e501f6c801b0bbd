# SPDX-License-Identifier: Apache-2.0
"""Figures of the basis itself: the functions, fits in one dimension, the coefficients' distribution."""
import math
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

from collect import size
from pictures import result
from plot import bytes_text, note_empty, save, title

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/examples"))
from radiance import wavelet  # noqa: E402  (spec 6.3, written plainly)


def draw_basis(out, experiment, rows):
    """16 functions of azimuth times 8 of gamma = sin(elevation), as the paper lays them out."""
    columns = [np.array([wavelet(2, i, (x + 0.5) / 64) for x in range(64)]) for i in range(16)]
    lines = [np.array([wavelet(2, i, (y + 0.5) / 64 - 0.5) for y in range(64)]) for i in range(8)]
    figure, axes = plt.subplots(8, 16, figsize=(11, 6), gridspec_kw={"wspace": 0.08, "hspace": 0.08})
    for i1, line in enumerate(lines):
        for i0, column in enumerate(columns):
            values = np.outer(line, column)
            peak = np.abs(values).max()
            axes[i1][i0].imshow(values, cmap="RdBu_r", vmin=-peak, vmax=peak, origin="lower", aspect="auto")
            axes[i1][i0].set_axis_off()
    figure.text(0.5, 0.06, "azimuth θ: 16 functions, each drawn over −π … π", ha="center")
    figure.text(0.09, 0.5, "γ = sin(elevation): 8 functions over −1 … 1", va="center", rotation=90)
    title(figure, experiment)
    return [save(figure, out, experiment["label"])]


def lobes(theta, peaks):
    """A diffuse floor and one specular lobe per peak, grey levels."""
    value = np.full_like(theta, 60.0)
    for centre, height in peaks:
        value = value + height * np.maximum(np.cos((theta - centre) / 2), 0) ** 60
    return value


def fit(theta, values, functions=32, ridge=0.02):
    """Ridge regression (paper Eq. 2) on the first functions of order 2; the constant is not penalised."""
    basis = np.array([[wavelet(2, i, t / (2 * math.pi)) for i in range(functions)] for t in theta])
    penalty = ridge * np.eye(functions)
    penalty[0, 0] = 0
    return np.linalg.solve(basis.T @ basis + penalty, basis.T @ values)


def draw_fit1d(out, experiment, rows):
    """Columns: one and two peaks; rows: 48, 24 and 12 observations."""
    fine = np.linspace(-math.pi, math.pi, 361)
    shapes = (("one light", [(0.4, 150)]), ("two lights", [(-1.2, 150), (1.0, 100)]))
    figure, axes = plt.subplots(3, 2, figsize=(8.6, 6.6), constrained_layout=True, sharex=True, sharey=True)
    curves = np.array([[wavelet(2, i, t / (2 * math.pi)) for i in range(32)] for t in fine])
    for line, count in enumerate((48, 24, 12)):
        theta = -math.pi + (np.arange(count) + 0.5) * 2 * math.pi / count
        for column, (name, peaks) in enumerate(shapes):
            axis = axes[line][column]
            noise = np.random.default_rng(7 + line).normal(0, 2, count)
            observed = lobes(theta, peaks) + noise
            axis.plot(fine, curves @ fit(theta, observed), color="#c8432f", label="fit, 32 wavelets, order 2")
            axis.plot(theta, observed, "o", color="#1f5fa8", label="observations")
            axis.plot(fine, lobes(fine, peaks), color="#888888", linewidth=0.8, linestyle=":", label="what was observed")
            axis.set_title(f"{name}, {count} observations")
            if line == 2:
                axis.set_xlabel("azimuth θ (rad)")
        axes[line][0].set_ylabel("luminance (grey levels)")
    axes[0][0].legend(loc="upper left")
    title(figure, experiment)
    return [save(figure, out, experiment["label"])]


def draw_histogram(out, experiment, rows):
    """Share of the coefficients per bin of magnitude, decoded from the first file of the experiment."""
    made = []
    for row, key in zip(rows, experiment["tasks"]):
        done = result(out, key)
        figure, axis = plt.subplots(figsize=(7, 3.8), constrained_layout=True)
        if done["status"] != "ok":
            note_empty(axis)
        else:
            edges = np.array(done["edges"])
            for name, text, color in (("others", "functions of direction", "#1f5fa8"), ("constant", "constant function (mean colour)", "#e69a35")):
                counts = np.array(done["counts"][name], float)
                axis.step(range(len(edges)), counts / max(counts.sum(), 1), where="mid", color=color, label=text)
            axis.set_yscale("log")
            axis.set_xticks(range(0, len(edges), 2), [f"≥ {edges[i]:.3g}" for i in range(0, len(edges), 2)], rotation=45)
            axis.set_xlabel("|coefficient| in grey levels (bin's lower edge)")
            axis.set_ylabel("share")
            axis.set_title(f"{row['capture']}, {row['split']}, Q = {row['rate']:g}, {bytes_text(size(row))}: {100 * done['zero']:.1f} % are zero")
            axis.legend()
        title(figure, experiment)
        made.append(save(figure, out, experiment["label"], f"_{key}" if len(rows) > 1 else ""))
    return made
