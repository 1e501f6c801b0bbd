"""Tables of a run, as (header, lines) of plain text; report.py makes HTML of them."""
from bd import NoFigure, bd_psnr, bd_rate
from collect import psnr, size
from plot import NAMES, bytes_text, grid_text

STAGES = [("geometry", "Geometry decompression"), ("coefficients", "Coefficient decompression"),
          ("images", "Images decompression"), ("observe", "Observation"), ("fit", "SLF representation (fit)")]


def _measured(rows, cameras):
    points = [(size(r), psnr(r, cameras)) for r in rows if size(r) and psnr(r, cameras) is not None]
    return [p[0] for p in points], [p[1] for p in points]


def _figure(measure, unit, *curves):
    """A BD figure by PCHIP (and Akima), or the reason why there is none."""
    try:
        return f"{measure(*curves):+.1f} {unit} ({measure(*curves, 'akima'):+.1f})" if unit == "%" else \
            f"{measure(*curves):+.2f} {unit} ({measure(*curves, 'akima'):+.2f})"
    except NoFigure as reason:
        return f"none: {reason}"


def bd_table(rows, anchor="igc-hevc"):
    """BD figures of every codec against one, per capture, density and preset, held out and input."""
    header = ["capture", "cameras", "preset", "codec", "BD-rate, held out", "BD-PSNR, held out", "BD-rate, input", "BD-PSNR, input"]
    cases = {}
    for row in rows:
        if row["experiment"].startswith("fig:rdcompare") and row["status"] == "ok":
            cases.setdefault((row["capture"], row["split"], row["preset"]), {}).setdefault(row["codec"], []).append(row)
    lines = []
    for (capture, split, preset), codecs in cases.items():
        for codec in (c for c in NAMES if c in codecs and c != anchor):
            line = [capture, split, preset, NAMES[codec]]
            for cameras in ("held_out", "input"):
                both = _measured(codecs.get(anchor, []), cameras) + _measured(codecs[codec], cameras)
                line += [_figure(bd_rate, "%", *both), _figure(bd_psnr, "dB", *both)]
            lines.append(line)
    return header, lines


def time_table(rows):
    """The paper's Table III: seconds per stage of the decoder; rows are stages, columns files."""
    rows = [r for r in rows if r["status"] == "ok" and r["eval"].get("decode")]
    header = ["seconds"] + [f"{NAMES[r['codec']]}, {r['capture']}, {r['preset']}" for r in rows]
    lines = []
    for stage, text in STAGES:
        found = [r["eval"]["decode"].get(stage) for r in rows]
        if any(v is not None for v in found):
            lines.append([text] + ["–" if v is None else f"{v:.3f}" for v in found])
    render = [(r["eval"].get("render") or {}).get("seconds_per_image") for r in rows]
    lines.append(["Rendering, one image"] + ["–" if v is None else f"{v:.3f}" for v in render])
    lines.append(["In total"] + [f"{r['eval']['decode']['total'] + (v or 0):.3f}" for r, v in zip(rows, render)])
    lines.append(["threads"] + [f"{r['eval']['decode'].get('threads', '–')}" for r in rows])
    lines.append(["file"] + [bytes_text(size(r)) for r in rows])
    return header, lines


def row_table(rows):
    """The rows of one experiment: rate, quality and times."""
    header = ["capture", "cameras", "codec", "preset", "setting", "rate option", "points", "bytes", "input dB", "held out dB",
              "image dB", "SSIM", "coverage", "encode s", "decode s", "peak MiB", "status"]
    lines = []
    for row in rows:
        image = (row["eval"].get("held_out") or {}).get("image") or {}
        number = lambda value, form: "" if value is None else format(value, form)  # noqa: E731
        lines.append([row["capture"], row["split"], NAMES[row["codec"]], row["preset"], grid_text(row["grid"]), f"{row['rate']:g}",
                      number(row["eval"].get("points"), ","), number(size(row), ","), number(psnr(row, "input"), ".2f"),
                      number(psnr(row), ".2f"), number(image.get("psnr"), ".2f"), number(image.get("ssim"), ".4f"),
                      number(image.get("coverage"), ".4f"), number(row["encode"].get("seconds", {}).get("total"), ".2f"),
                      number((row["eval"].get("decode") or {}).get("total"), ".3f"), number(row["encode"].get("peak_memory_mib"), ".0f"),
                      row["status"] if row["status"] == "ok" else f"{row['status']}: {row['reason']}"])
    return header, lines
