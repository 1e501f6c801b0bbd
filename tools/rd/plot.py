# SPDX-License-Identifier: Apache-2.0
"""Figures of a run, PNG and SVG, under OUT/figures. The same rows give the same SVG bytes."""
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of backend)
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

from collect import image_psnr, psnr, size  # noqa: E402

matplotlib.rcParams |= {"svg.hashsalt": "slf", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.titlesize": 9,
                        "legend.fontsize": 8, "figure.dpi": 110, "lines.markersize": 4.5, "lines.linewidth": 1.4}
NAMES = {"raht": "SLF-RAHT", "tmc": "SLF-TMC", "tmc3": "G-PCC (tmc3)", "igc-hevc": "IGC, HEVC low delay",
         "igc-hevc-intra": "IGC, HEVC intra", "igc-av1": "IGC, AV1"}
STYLE = {"raht": ("#1f5fa8", "o"), "tmc": ("#2a9d54", "s"), "tmc3": ("#6f6f6f", "D"), "igc-hevc": ("#c8432f", "^"),
         "igc-hevc-intra": ("#e69a35", "v"), "igc-av1": ("#8a4fb0", "X")}
SYMBOLS = {"order": "o", "functions": "N", "lambda": "λ", "beta": "β", "delta": "δ", "grid-bits": "grid bits"}
POINTS, PICTURES = "point PSNR (dB)", "image PSNR (dB)"
QUALITY = {POINTS: psnr, PICTURES: image_psnr}
SETS = (("input", "Input set"), ("held_out", "Evaluation set (held out)"))
SERIES = plt.get_cmap("viridis")


def save(figure, out, label, suffix=""):
    """Relative paths of the PNG and the SVG."""
    stem = label.replace(":", "_") + suffix
    folder = pathlib.Path(out) / "figures"
    folder.mkdir(exist_ok=True)
    for kind, metadata in (("png", {"Software": None}), ("svg", {"Date": None, "Creator": None})):
        figure.savefig(folder / f"{stem}.{kind}", metadata=metadata, bbox_inches="tight")
    plt.close(figure)
    return {"png": f"figures/{stem}.png", "svg": f"figures/{stem}.svg"}


def bytes_text(value, _=None):
    for unit, factor in (("MB", 1e6), ("kB", 1e3)):
        if value >= factor:
            return f"{value / factor:.3g} {unit}"
    return f"{value:.3g} B"


def rate_axis(axis):
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(LogLocator(10, subs=(1, 2, 3, 5)))
    axis.xaxis.set_major_formatter(FuncFormatter(bytes_text))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.tick_params(axis="x", labelrotation=45)
    axis.set_xlabel("file size")


def measured(experiment):
    """The qualities that an experiment's curves have."""
    return list(QUALITY) if experiment["images"] else [POINTS]


def curve(axis, rows, cameras, delta, quality=POINTS, **style):
    """One series; rows without a figure are left out."""
    of = QUALITY[quality]
    points = sorted((size(row), of(row, cameras, delta)) for row in rows
                    if size(row) is not None and of(row, cameras, delta) is not None)
    if points:
        axis.plot(*zip(*points), **style)
    return bool(points)


def grid_text(values):
    return ", ".join(f"{SYMBOLS.get(k, k)} = {v:g}" if isinstance(v, (int, float)) else f"{k} {v}" for k, v in values.items())


def setting_text(row):
    return row["variant"] or grid_text(row["grid"])


def grid_series(rows):
    """[(text, rows)] by the value of the grid or the variant, in the manifest's order."""
    groups = {}
    for row in rows:
        groups.setdefault(setting_text(row), []).append(row)
    return list(groups.items())


def title(figure, experiment, more=""):
    figure.suptitle(f"{experiment['label']}   {experiment['title']}{more}", fontsize=10.5)


def note_empty(axis):
    axis.text(0.5, 0.5, "no results", ha="center", va="center", transform=axis.transAxes, color="#888888")


def series_panels(axes, rows, panels):
    """panels: [(cameras, delta, quality, title)], one axis each; one series per value of the grid or variant."""
    groups = grid_series(rows)
    for axis, (cameras, delta, quality, text) in zip(axes, panels):
        drawn = [curve(axis, part, cameras, delta, quality, label=name, marker="osD^vXP*"[i % 8],
                       color=SERIES(0.9 * i / max(len(groups) - 1, 1))) for i, (name, part) in enumerate(groups)]
        axis.set_title(text)
        rate_axis(axis)
        axis.set_ylabel(quality if axis is axes[0] or quality != POINTS else "")
        if not any(drawn):
            note_empty(axis)
    if axes[-1].lines:
        beside = {"loc": "center left", "bbox_to_anchor": (1, 0.5)} if rows[0]["variant"] else {}  # their names are long
        axes[-1].legend(**beside)


def draw_grid(out, experiment, rows, panels, width):
    """One file per capture and split."""
    made = []
    cases = sorted({(row["capture"], row["split"]) for row in rows})
    for capture, split in cases:
        figure, axes = plt.subplots(1, len(panels), figsize=(width, 3.6), constrained_layout=True, squeeze=False)
        series_panels(axes[0], [r for r in rows if (r["capture"], r["split"]) == (capture, split)], panels)
        title(figure, experiment, f"   ({capture}, {split})")
        made.append(save(figure, out, experiment["label"], f"_{capture}_{split}" if len(cases) > 1 else ""))
    return made


def draw_curves(out, experiment, rows):
    delta = 10 if 10 in experiment["deltas"] else experiment["deltas"][0]
    panels = [(cameras, delta, quality, text) for quality in measured(experiment) for cameras, text in SETS]
    return draw_grid(out, experiment, rows, panels, 4.1 * len(panels))


def draw_deltas(out, experiment, rows):
    panels = [("held_out", delta, POINTS, f"δ′ = {delta:g}°, held out") for delta in experiment["deltas"]]
    return draw_grid(out, experiment, rows, panels, 2.9 * len(panels))


def draw_compare(out, experiment, rows):
    """Rows: input, held out, of points, then of pictures; columns: splits; one file per capture."""
    made, splits = [], experiment["splits"]
    captures = sorted({row["capture"] for row in rows})
    for capture in captures:
        panels = [(quality, cameras, text) for quality in measured(experiment) for cameras, text in SETS]
        figure, axes = plt.subplots(len(panels), len(splits), figsize=(1.2 + 3.4 * len(splits), 3.3 * len(panels)), constrained_layout=True,
                                    squeeze=False)
        for column, split in enumerate(splits):
            for line, (quality, cameras, text) in enumerate(panels):
                axis = axes[line][column]
                for codec in experiment["codecs"]:
                    for preset in experiment["presets"]:
                        part = [r for r in rows if (r["capture"], r["split"], r["codec"], r["preset"]) == (capture, split, codec, preset)]
                        color, marker = STYLE[codec]
                        curve(axis, part, cameras, 10, quality, color=color, marker=marker, linestyle="-" if preset == "paper" else "--",
                              label=f"{NAMES[codec]}, {preset}" if len(experiment["presets"]) > 1 else NAMES[codec])
                axis.set_title(f"{split}, {text.lower()}")
                rate_axis(axis)
                axis.set_ylabel(quality)
                if not axis.lines:
                    note_empty(axis)
        handles = {h.get_label(): h for row in axes for axis in row for h in axis.lines}
        if handles:
            figure.legend(handles=list(handles.values()), loc="upper center", ncol=min(4, len(handles)), bbox_to_anchor=(0.5, 0))
        title(figure, experiment, f"   ({capture})" if len(captures) > 1 else "")
        made.append(save(figure, out, experiment["label"], f"_{capture}" if len(captures) > 1 else ""))
    return made


def draw(out, plan, rows):
    """{label: [{"png", "svg"}]} of every experiment; one that cannot be drawn has an empty list."""
    import drawings
    import pictures
    kinds = {"curves": draw_curves, "ablation": draw_curves, "deltas": draw_deltas, "compare": draw_compare, "views": pictures.draw_views,
             "orbit": pictures.draw_orbit, "histogram": drawings.draw_histogram, "basis": drawings.draw_basis,
             "fit1d": drawings.draw_fit1d}
    figures = {}
    for experiment in plan["experiments"]:
        own = [row for row in rows if row["experiment"] == experiment["label"]]
        make = kinds.get(experiment["figure"])
        figures[experiment["label"]] = make(out, experiment, own) if make else []
    return figures
