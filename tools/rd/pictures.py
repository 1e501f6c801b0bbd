# SPDX-License-Identifier: Apache-2.0
"""Figures that show renderings: views beside the photograph, and sheets of a circle of views."""
import json
import pathlib

import matplotlib.image
import matplotlib.pyplot as plt

from collect import psnr, size
from plot import bytes_text, grid_text, note_empty, save, title


def result(out, key):
    path = pathlib.Path(out) / "tasks" / key / "done.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"status": "missing", "reason": "did not finish"}


def show(axis, path, text):
    axis.set_axis_off()
    axis.set_title(text)
    try:
        axis.imshow(matplotlib.image.imread(path), interpolation="nearest")
    except (OSError, SyntaxError):  # what matplotlib raises for a file that is no image
        note_empty(axis)


def caption(experiment, row):
    """What sets this picture apart in its experiment, and its size, as the paper's captions have it."""
    words = [row["split"]] if len(experiment["splits"]) > 1 else []
    words += [grid_text(row["grid"])] if row["grid"] else []
    words += [f"Q = {row['rate']:g}"] if len(experiment["rates"][row["codec"]]) > 1 else []
    if not size(row):
        return " ".join(words + [row["status"]])
    quality = psnr(row)
    points = f"{row['eval']['points']:,} points, " if "grid-bits" in row["grid"] else ""
    return f"{', '.join(words)}\n{points}{bytes_text(size(row))}" + (f", {quality:.2f} dB" if quality else "")


def draw_views(out, experiment, rows):
    """The photograph, then one rendering per point; one file per capture."""
    made = []
    captures = sorted({row["capture"] for row in rows})
    for capture in captures:
        shown = [(row, key) for row, key in zip(rows, experiment["tasks"]) if row["capture"] == capture]
        figure, axes = plt.subplots(1, 1 + len(shown), figsize=(2.6 * (1 + len(shown)), 3.3), constrained_layout=True)
        photographs = [done["photograph"] for done in (result(out, key) for _, key in shown) if done["status"] == "ok"]
        show(axes[0], photographs[0] if photographs else "", "photograph (held out)\n")
        for axis, (row, key) in zip(axes[1:], shown):
            show(axis, pathlib.Path(out) / "tasks" / key / "view.png", caption(experiment, row))
        title(figure, experiment, f"   ({capture})")
        made.append(save(figure, out, experiment["label"], f"_{capture}" if len(captures) > 1 else ""))
    return made


def draw_orbit(out, experiment, rows):
    made = []
    for row, key in zip(rows, experiment["tasks"]):
        figure, axis = plt.subplots(figsize=(9, 4.8), constrained_layout=True)
        show(axis, pathlib.Path(out) / "tasks" / key / "sheet.png", caption(experiment, row).strip())
        title(figure, experiment, f"   ({row['capture']})")
        made.append(save(figure, out, experiment["label"], f"_{key}" if len(rows) > 1 else ""))
    return made
