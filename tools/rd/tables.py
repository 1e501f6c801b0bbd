# SPDX-License-Identifier: Apache-2.0
"""Tables of a run, as (header, lines) of plain text; report.py makes HTML of them."""
from bd import NoFigure, bd_psnr, bd_rate
from collect import image_psnr, psnr, size, size_without_geometry
from plot import NAMES, bytes_text, setting_text

STAGES = [("geometry", "Geometry decompression"), ("coefficients", "Coefficient decompression"),
          ("images", "Images decompression"), ("observe", "Observation"), ("fit", "SLF representation (fit)")]
BD_NOTE = ("Negative rate: fewer bytes than IGC at equal PSNR, first of points, then, where images were rendered, of pictures (image PSNR, where "
           "both show the object). PCHIP; Akima in brackets. Without geometry: each file's bytes less "
           "those of its own geometry unit (an .igc file's is a whole stream, some 60 bytes more). Where curves do not overlap there is "
           "no figure but a reason.")
ABLATION_NOTE = ("BD-rate (PCHIP, percent) against the first variant of the same capture, cameras and codec; negative: fewer bytes at equal "
                 "point PSNR, or at equal PSNR of rendered images. Bytes and dB are those at the middle rate (the lower of two). "
                 "Seconds are means over the rates, one thread; × first: their ratio to the first variant's.")


def _measured(rows, cameras, measure=size, quality=psnr):
    points = [(measure(r), quality(r, cameras)) for r in rows if measure(r) and quality(r, cameras) is not None]
    return [p[0] for p in points], [p[1] for p in points]


def _figure(measure, unit, *curves, akima=True):
    """A BD figure by PCHIP (and Akima), or the reason why there is none."""
    form = "+.1f" if unit == "%" else "+.2f"
    try:
        return f"{measure(*curves):{form}} {unit}" + (f" ({measure(*curves, 'akima'):{form}})" if akima else "")
    except NoFigure as reason:
        return f"none: {reason}"


def bd_tables(rows):
    """[(header, lines)] of points and of pictures; those that were measured."""
    return [table for table in (bd_table(rows), bd_table([r for r in rows if image_psnr(r) is not None], quality=image_psnr)) if table[1]]


def bd_table(rows, anchor="igc-hevc", quality=psnr):
    """BD figures of every codec against one, per experiment, capture, density and preset, held out and input."""
    header = ["experiment", "capture", "cameras", "preset", "codec" if quality is psnr else "codec, pictures"]
    header += [f"{what}, {cameras}" for cameras in ("held out", "input") for what in ("BD-rate", "BD-rate without geometry", "BD-PSNR")]
    cases = {}
    for row in rows:
        if row["experiment"].startswith("fig:rdcompare") and row["status"] == "ok" and not row["variant"]:
            case = tuple(row[key] for key in ("experiment", "capture", "split", "preset"))
            cases.setdefault(case, {}).setdefault(row["codec"], []).append(row)
    lines = []
    for case, codecs in cases.items():
        for codec in (c for c in NAMES if c in codecs and c != anchor):
            line = [*case, NAMES[codec]]
            for cameras in ("held_out", "input"):
                whole, less = (_measured(codecs.get(anchor, []), cameras, measure, quality)
                               + _measured(codecs[codec], cameras, measure, quality) for measure in (size, size_without_geometry))
                line += [_figure(bd_rate, "%", *whole), _figure(bd_rate, "%", *less), _figure(bd_psnr, "dB", *whole)]
            lines.append(line)
    return header, lines


def _seconds(rows):
    """({rate: seconds of encoding}, {rate: seconds of decoding})"""
    encode = {r["rate"]: r["encode"].get("seconds", {}).get("total") for r in rows}
    decode = {r["rate"]: (r["eval"].get("decode") or {}).get("total") for r in rows}
    return [{rate: s for rate, s in found.items() if s is not None} for found in (encode, decode)]


def _mean_and_ratio(anchor, seconds):
    """Cells; the ratio is over the rates that both have."""
    both = anchor.keys() & seconds.keys()
    base = sum(anchor[rate] for rate in both)
    return [f"{sum(seconds.values()) / len(seconds):.3f}" if seconds else "–",
            f"{sum(seconds[rate] for rate in both) / base:.2f}" if base else "–"]


def _ablation_line(anchor, rows, middle, qualities):
    """What stands behind the name of one variant; `rows` is `anchor` for the first."""
    line = []
    for quality in qualities:
        for cameras in ("held_out", "input"):
            both = _measured(anchor, cameras, quality=quality) + _measured(rows, cameras, quality=quality)
            line.append("–" if rows is anchor else _figure(bd_rate, "%", *both, akima=False))
    at = next((r for r in rows if r["rate"] == middle and size(r)), None)
    line += [f"{middle:g}", f"{size(at):,}" if at else "–"]
    for quality in qualities:
        value = at and quality(at)
        line.append("–" if value is None else f"{value:.2f}")
    for base, seconds in zip(_seconds(anchor), _seconds(rows)):
        line += _mean_and_ratio(base, seconds)
    return line


def ablation_table(rows):
    """Every variant against the first of its capture, split and codec, in the manifest's order."""
    images = any(image_psnr(row) is not None for row in rows)
    qualities = (psnr, image_psnr) if images else (psnr,)
    header = ["capture", "cameras", "codec", "variant", "BD-rate, held out", "BD-rate, input",
              *(("images: BD-rate, held out", "images: BD-rate, input") if images else ()), "rate option", "bytes", "held out dB",
              *(("image dB",) if images else ()), "encode s", "× first", "decode s", "× first"]
    cases = {}
    for row in rows:
        cases.setdefault((row["capture"], row["split"], row["codec"]), {}).setdefault(row["variant"], []).append(row)
    lines = []
    for (capture, split, codec), variants in cases.items():
        anchor = next(iter(variants.values()))
        rates = sorted(r["rate"] for r in anchor)
        for name, own in variants.items():
            lines.append([capture, split, NAMES[codec], name, *_ablation_line(anchor, own, rates[(len(rates) - 1) // 2], qualities)])
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
              "image dB", "SSIM", "MS-SSIM", "coverage", "image dB, input", "encode s", "decode s", "peak MiB", "status"]
    lines = []
    for row in rows:
        image = (row["eval"].get("held_out") or {}).get("image") or {}
        number = lambda value, form: "" if value is None else format(value, form)  # noqa: E731
        lines.append([row["capture"], row["split"], NAMES[row["codec"]], row["preset"], setting_text(row), f"{row['rate']:g}",
                      number(row["eval"].get("points"), ","), number(size(row), ","), number(psnr(row, "input"), ".2f"),
                      number(psnr(row), ".2f"), number(image.get("psnr"), ".2f"), number(image.get("ssim"), ".4f"),
                      number(image.get("ms_ssim"), ".4f"), number(image.get("coverage"), ".4f"), number(image_psnr(row, "input"), ".2f"),
                      number(row["encode"].get("seconds", {}).get("total"), ".2f"),
                      number((row["eval"].get("decode") or {}).get("total"), ".3f"), number(row["encode"].get("peak_memory_mib"), ".0f"),
                      row["status"] if row["status"] == "ok" else f"{row['status']}: {row['reason']}"])
    return header, lines


OF_FIGURE = {"time": (time_table, ""), "ablation": (ablation_table, ABLATION_NOTE)}  # figure: (its table, a remark above it)
