# SPDX-License-Identifier: Apache-2.0
"""Plots and the table of the related codecs."""
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of backend)

from bd import NoFigure, bd_rate  # noqa: E402
from plot import bytes_text, rate_axis  # noqa: E402

ANCHOR = "slf"
SETS = (("held_out", "observations of held-out cameras"), ("fitted", "observations of fitted cameras"))
STYLE = {"slf": ("#1f5fa8", "o", "-"), "the paper": ("#1f5fa8", "s", "--"), "IGC, HEVC": ("#c8432f", "^", "-"),
         "multi-view, predicted": ("#c8432f", "v", "--"), "Wood, principal functions": ("#2a9d54", "o", "-"),
         "Wood, function quantisation": ("#2a9d54", "s", "--"), "Chen, PCA": ("#8a4fb0", "o", "-"), "Chen, NMF": ("#8a4fb0", "s", "--"),
         "Miller, planes by RAHT": ("#e69a35", "o", "-"), "Miller, each point alone": ("#e69a35", "s", "--"),
         "RAHT-KLT": ("#444444", "D", "-"), "Volino, spread": ("#b5a642", "o", "-"), "Volino, most frontal": ("#b5a642", "s", "--")}


def front(rows, quality):
    """(bytes, dB) ascending in both: settings that another beats in both are left out."""
    out = []
    for row in sorted(rows, key=lambda r: (r["bytes"], -r[quality])):
        if not out or row[quality] > out[-1][1]:
            out.append((row["bytes"], row[quality]))
    return out


def curves_of(rows, quality):
    """{(capture, codec): front}."""
    groups = {}
    for row in rows:
        groups.setdefault((row["capture"], row["codec"]), []).append(row)
    return {key: front(some, quality) for key, some in groups.items()}


def bytes_at(anchor, quality):
    """Bytes of the anchor at a quality in its range; log bytes are linear between its settings."""
    rates, qualities = zip(*anchor)
    return float(np.exp(np.interp(quality, qualities, np.log(rates))))


def figure_text(anchor, curve):
    """BD-rate against the anchor; where there is none, the best point that both can be compared at, or which of both ends where."""
    try:
        return f"{bd_rate(*zip(*anchor), *zip(*curve)):+.0f} %"
    except NoFigure:
        shared = [(size, quality) for size, quality in curve if anchor[0][1] <= quality <= anchor[-1][1]]
        if shared:
            size, quality = shared[-1]
            return f"{quality:.1f} dB: {bytes_text(size)}, ours {bytes_text(bytes_at(anchor, quality))}"
        size, quality = curve[-1] if curve[-1][1] < anchor[0][1] else curve[0]
        end = anchor[0] if quality < anchor[0][1] else anchor[-1]
        return f"{quality:.1f} dB at {bytes_text(size)}; ours {'from' if quality < end[1] else 'to'} {end[1]:.1f} dB at {bytes_text(end[0])}"


def table(rows):
    names = sorted({row["capture"] for row in rows})
    lines = ["| codec | " + " | ".join(f"{n}, {s}" for n in names for s in ("held out", "fitted")) + " |",
             "|---" * (1 + 2 * len(names)) + "|"]
    curves = {quality: curves_of(rows, quality) for quality, _ in SETS}
    for codec in STYLE:
        cells = []
        for name in names:
            for quality, _ in SETS:
                anchor, curve = (curves[quality].get((name, c)) for c in (ANCHOR, codec))
                cells.append("anchor" if codec == ANCHOR else figure_text(anchor, curve) if anchor and curve else "not made")
        lines.append(f"| {codec} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def draw(out, capture, rows):
    figure, axes = plt.subplots(1, 2, figsize=(11.5, 4.6), constrained_layout=True)
    for axis, (quality, title) in zip(axes, SETS):
        curves = curves_of(rows, quality)
        for codec, (colour, marker, line) in STYLE.items():
            if (capture, codec) in curves:
                axis.plot(*zip(*curves[capture, codec]), color=colour, marker=marker, linestyle=line, label=codec,
                          linewidth=2.4 if codec == ANCHOR else 1.3)
        rate_axis(axis)
        axis.set_title(title)
        axis.set_ylabel("point PSNR (dB)")
    points = max(row["points"] for row in rows if row["capture"] == capture)
    axes[1].legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.suptitle(f"{capture}, {points:,} points: file size, lossless geometry included", fontsize=10.5)
    figure.savefig(out / f"{capture}.png", metadata={"Software": None}, bbox_inches="tight")
    plt.close(figure)


def write(out, rows):
    for capture in sorted({row["capture"] for row in rows}):
        draw(out, capture, rows)
    text = table(rows)
    (out / "table.md").write_text(text + "\n", encoding="utf-8")
    print(text)
