# SPDX-License-Identifier: Apache-2.0
"""The paper's findings, each judged by a rule written here, from the rows of a run.

A verdict is "agrees", "contradicts" or "undecided", with the figures it rests on; nothing is tuned to
agree. tools/rd/verdicts.json records those of the quick run; `rd.py quick --check` fails where one flips.
PSNR is the pooled point PSNR (RGB) of held-out cameras at an evaluation angle of 10 degrees, and
settings are the paper's, unless a rule says otherwise.
"""
import json
import pathlib

import numpy as np

from bd import NoFigure, bd_rate
from collect import psnr, size

RECORD = pathlib.Path(__file__).resolve().parent / "verdicts.json"
AGREES, CONTRADICTS, UNDECIDED = "agrees", "contradicts", "undecided"
SAME = 0.02   # dB; closer curves are called equal
CLOSE = 0.1   # dB; "close to the best", "saturates"
CLEARLY = 1.0  # dB; "far superior", "clearly worse"
LOSSLESS = 0.05  # dB; "at no loss"
FLAT = 0.2  # dB; a held-out curve that spans less is limited by the fit and says nothing about rate


def ok(rows, figure, **values):
    """Finished rows in the preset paper, with these values, of the experiment or of all whose label goes on with _."""
    return [r for r in rows if (r["experiment"] + "_").startswith(figure + "_") and r["status"] == "ok" and r["preset"] == "paper"
            and all(r[k] == v for k, v in values.items()) and size(r) and psnr(r) is not None]


def curve(rows, cameras="held_out", delta=10):
    """(bytes, PSNR) arrays by ascending bytes."""
    points = sorted((size(r), psnr(r, cameras, delta)) for r in rows if psnr(r, cameras, delta) is not None)
    return np.array([p[0] for p in points], float), np.array([p[1] for p in points], float)


def common_rates(curves):
    """Lowest and highest rate that all curves reach, or None."""
    low, high = max(rate[0] for rate, _ in curves), min(rate[-1] for rate, _ in curves)
    return (low, high) if low <= high else None


def at_rate(one, rate):
    """PSNR at a rate, linear in log rate (held-out curves need not be monotone)."""
    return float(np.interp(np.log(rate), np.log(one[0]), one[1]))


def mean_psnr(one, low, high):
    return float(np.mean([at_rate(one, rate) for rate in np.geomspace(low, high, 33)]))


def by_value(rows, name):
    """{value of the grid: rows}; rows of a grid without `name` are left out."""
    out = {}
    for row in rows:
        if name in row["grid"]:
            out.setdefault(row["grid"][name], []).append(row)
    return out


def captures(rows, figure):
    return sorted({r["capture"] for r in rows if (r["experiment"] + "_").startswith(figure + "_")})


def lacking(groups, *needed):
    """Why a rule cannot be applied, or None."""
    missing = [f"{v:g}" for v in needed if v not in groups]
    return f"no finished encodes for {', '.join(missing)}" if missing else None


def order(rows):
    """At the highest rate that all orders reach, o = 2 has the highest PSNR, by more than 0.02 dB."""
    groups = by_value(rows, "order")
    if lacking(groups, 1, 2, 3, 4):
        return UNDECIDED, lacking(groups, 1, 2, 3, 4)
    curves = {o: curve(part) for o, part in groups.items()}
    span = common_rates(curves.values())
    if not span:
        return UNDECIDED, "the orders reach no rate in common"
    found = {o: at_rate(one, span[1]) for o, one in curves.items()}
    inputs = {o: at_rate(curve(part, "input"), span[1]) for o, part in groups.items()}
    best = max((o for o in found if o != 2), key=found.get)
    margin = found[2] - found[best]
    text = f"o = 2 {margin:+.2f} dB to o = {best} at {span[1] / 1000:.0f} kB; input set best at o = {max(inputs, key=inputs.get)}"
    return (UNDECIDED if abs(margin) <= SAME else AGREES if margin > 0 else CONTRADICTS), text


def ridge(rows):
    """At every Q, every lambda of 0.1 and more has a PSNR at least 1 dB above that of the least lambda,
    1e-6, which stands for 0."""
    groups = by_value(rows, "lambda")
    least = min(groups, default=1)
    if least >= 0.1 or len(groups) < 2:
        return UNDECIDED, "no finished encodes for lambda = 1e-6 and another"
    zero = {r["rate"]: r for r in groups[least]}
    gains = [psnr(r) - psnr(zero[r["rate"]]) for v, part in groups.items() if v >= 0.1 for r in part if r["rate"] in zero]
    if not gains:
        return UNDECIDED, "no Q in common"
    sizes = [size(zero[r["rate"]]) / size(r) for r in groups.get(0.8, []) if r["rate"] in zero]
    text = f"λ of 0.1 and more is better by {min(gains):.2f} to {max(gains):.2f} dB than {least:g}" + \
        (f", which takes {np.mean(sizes):.1f} times the bytes of λ = 0.8" if sizes else "")
    return (AGREES if min(gains) >= CLEARLY else CONTRADICTS if min(gains) < 0 else UNDECIDED), text


def delta(rows):
    """For every evaluation angle, delta = 10 is within 0.1 dB of the best: mean PSNR over the rates in common."""
    groups = by_value(rows, "delta")
    if lacking(groups, 10) or len(groups) < 2:
        return UNDECIDED, "no finished encodes for delta = 10 and another"
    behind = {}
    for angle in sorted({p["delta"] for r in rows for p in r["eval"]["held_out"]["points"]}):
        curves = {d: curve(part, delta=angle) for d, part in groups.items()}
        span = common_rates(curves.values())
        if not span:
            return UNDECIDED, "the curves reach no rate in common"
        means = {d: mean_psnr(one, *span) for d, one in curves.items()}
        behind[angle] = (max(means.values()) - means[10], max(means, key=means.get))
    text = ", ".join(f"δ′ = {a:g}: " + (f"{gap:.2f} dB behind δ = {d:g}" if d != 10 else "best") for a, (gap, d) in behind.items())
    return (AGREES if all(gap <= CLOSE for gap, _ in behind.values()) else CONTRADICTS), text


def functions(rows):
    """At the finest Q, doubling N twice to the largest moves the PSNR by at most 0.1 dB."""
    groups = by_value(rows, "functions")
    if len(groups) < 3:
        return UNDECIDED, "fewer than three N finished"
    finest = min(r["rate"] for part in groups.values() for r in part)
    found = {n: (psnr(r), psnr(r, "input")) for n, part in sorted(groups.items()) for r in part if r["rate"] == finest}
    if len(found) < 3:
        return UNDECIDED, "fewer than three N finished at the finest Q"
    *_, before, last = sorted(found)
    gain, gain_input = found[last][0] - found[before][0], found[last][1] - found[before][1]
    text = f"N = {before:g} to {last:g}: {gain:+.2f} dB held out, {gain_input:+.2f} dB input; held out " + \
        ", ".join(f"{n:g}: {v[0]:.2f}" for n, v in found.items())
    if gain < -CLOSE:
        return CONTRADICTS, "it falls, over-fitting stronger than the paper's: " + text
    return (AGREES if gain <= CLOSE else CONTRADICTS), text


def smoothness(rows):
    """At every Q, beta = 1.3 takes fewer bytes than beta = 0 and loses at most 0.05 dB."""
    groups = by_value(rows, "beta")
    if lacking(groups, 0, 1.3):
        return UNDECIDED, lacking(groups, 0, 1.3)
    zero = {r["rate"]: r for r in groups[0]}
    pairs = [(size(r) / size(zero[r["rate"]]) - 1, psnr(r) - psnr(zero[r["rate"]])) for r in groups[1.3] if r["rate"] in zero]
    if not pairs:
        return UNDECIDED, "no Q in common"
    saved, gains = zip(*pairs)
    text = f"bytes {100 * min(saved):+.1f} to {100 * max(saved):+.1f} %, PSNR {min(gains):+.2f} to {max(gains):+.2f} dB"
    good = max(saved) < 0 and min(gains) >= -LOSSLESS
    return (AGREES if good else CONTRADICTS), text


def density(rows):
    """At the finest Q, the Die loses more PSNR from dense to sparse cameras than the Can, by more than 0.1 dB."""
    drops = {}
    for name in ("can", "die"):
        own = ok(rows, f"fig:rdcompare_{name}", codec="raht") or ok(rows, f"fig:rdcompare_blender_{name}", codec="raht")
        finest = min((r["rate"] for r in own), default=None)
        found = {r["split"]: psnr(r) for r in own if r["rate"] == finest}
        if not {"dense", "sparse"} <= set(found):
            return UNDECIDED, f"no finished dense and sparse encodes of the {name}"
        drops[name] = found["dense"] - found["sparse"]
    margin = drops["die"] - drops["can"]
    text = f"dense to sparse the Die loses {drops['die']:.2f} dB, the Can {drops['can']:.2f} dB"
    return (UNDECIDED if abs(margin) <= CLOSE else AGREES if margin > 0 else CONTRADICTS), text


def against(anchor, test):
    """(sign, text) of two lists of rows: -1 where test needs less. Held out; where that is flat, the input set."""
    one, two = curve(anchor), curve(test)
    if not len(one[0]) or not len(two[0]):
        return 0, "not finished"
    if min(np.ptp(one[1]), np.ptp(two[1])) >= FLAT:
        return compare(one, two)
    sign, text = compare(curve(anchor, "input"), curve(test, "input"))
    return sign, f"{text} on the input set (held out is flat)"


def compare(one, two):
    """By BD-rate; where there is none, by PSNR over the rates in common; without such, by who dominates."""
    try:
        figure = bd_rate(*one, *two)
        return (0 if abs(figure) < 1 else np.sign(figure)), f"BD-rate {figure:+.1f} %"
    except NoFigure as reason:
        span = common_rates([one, two])
        if span:
            gain = mean_psnr(two, *span) - mean_psnr(one, *span)
            return (0 if abs(gain) <= SAME else -np.sign(gain)), f"{gain:+.2f} dB at the rates in common (no BD-rate: {reason})"
        if two[0][-1] < one[0][0]:
            sign = -1 if two[1].max() >= one[1].max() else 0
        else:
            sign = 1 if one[1].max() >= two[1].max() else 0
        best = [f"{psnrs.max():.2f} dB in {rates[-1] / 1000:.0f} kB" for rates, psnrs in (two, one)]
        return sign, f"no rate in common; best {best[0]} against {best[1]}"


def pairs(rows, anchor, tests):
    """[(case, {test: (sign, text)})] over captures and splits of the comparisons."""
    cases = sorted({(r["capture"], r["split"]) for r in rows if r["experiment"].startswith("fig:rdcompare")})
    out = []
    for capture, split in cases:
        part = {codec: ok(rows, "fig:rdcompare", capture=capture, split=split, codec=codec) for codec in (anchor, *tests)}
        out.append((f"{capture} {split}", {test: against(part[anchor], part[test]) for test in tests}))
    return out


def unanimous(found):
    """Verdict over cases: signs -1 agree."""
    signs = [sign for _, sign, _ in found]
    word = AGREES if signs and all(s < 0 for s in signs) else CONTRADICTS if signs and all(s > 0 for s in signs) else UNDECIDED
    reason = "" if word != UNDECIDED else f"{sum(s < 0 for s in signs)} of {len(signs)} cases agree, {sum(s > 0 for s in signs)} contradict: "
    return word, reason + "; ".join(f"{case}: {text}" for case, _, text in found)


def texture(rows):
    """SLF-TMC has the lower BD-rate (by over 1 %) against SLF-RAHT on every capture and density; without
    BD-rate, PSNR at common rates; input set where held out spans under 0.2 dB."""
    return unanimous([(case, *found["tmc"]) for case, found in pairs(rows, "raht", ["tmc"])])


def image_coding(rows):
    """SLF (TMC, as the paper compares it) has the lower BD-rate against IGC (HEVC low delay) on every capture and density; else as above."""
    found = pairs(rows, "igc-hevc", ["tmc", "raht"])
    word, text = unanimous([(case, *both["tmc"]) for case, both in found])
    raht = unanimous([(case, *both["raht"]) for case, both in found])
    return word, f"{text} | SLF-RAHT {raht[0]}: {raht[1]}"


def decoding(rows):
    """Printed, not judged: times are a machine's."""
    out = []
    for capture in captures(rows, "tab:time"):
        own = {r["codec"]: r["eval"]["decode"]["total"] for r in ok(rows, "tab:time", capture=capture) if r["eval"].get("decode")}
        out.append(f"{capture}: " + ", ".join(f"{codec} {seconds:.2f} s" for codec, seconds in own.items()))
    return "printed", "; ".join(out) or "nothing timed"


# id: (finding, experiment swept, rule). With an experiment the rule is applied per capture.
FINDINGS = {
    "order": ("o = 2 is best at high rate", "fig:order", order),
    "lambda": ("λ = 0 is clearly worse on held-out views", "fig:lambda", ridge),
    "delta": ("δ = 10° is best or close to it at every δ′", "fig:delta_c", delta),
    "functions": ("N saturates on held-out views", "fig:n_basis", functions),
    "beta": ("β saves rate at no loss", "fig:beta", smoothness),
    "density": ("sparse cameras hurt the Die more than the Can", None, density),
    "tmc": ("SLF-TMC beats SLF-RAHT in rate", None, texture),
    "igc": ("SLF beats IGC in rate", None, image_coding),
    "time": ("SLF decodes faster than IGC", None, decoding),
}


def judge(rows):
    """{id: {"finding", "rule", "verdict", "figure"}}; variants are not the paper's and say nothing here."""
    rows = [row for row in rows if not row["variant"]]
    out = {}
    for name, (finding, swept, rule) in FINDINGS.items():
        if swept:
            found = [(c, *rule(ok(rows, swept, capture=c))) for c in captures(rows, swept)]
            words = {word for _, word, _ in found}
            verdict = words.pop() if len(words) == 1 else UNDECIDED
            figure = "; ".join(f"{c}{'' if len(found) == 1 else ' ' + word}: {text}" for c, word, text in found) or "not run"
        else:
            verdict, figure = rule(rows)
        out[name] = {"finding": finding, "rule": " ".join(rule.__doc__.split()), "verdict": verdict, "figure": figure}
    return out


def lines(judged):
    return [f"{v['verdict']:11} {v['finding']}: {v['figure']}" for v in judged.values()]


def record(judged):
    kept = {name: {"verdict": v["verdict"], "figure": v["figure"]} for name, v in judged.items() if v["verdict"] != "printed"}
    RECORD.write_text(json.dumps(kept, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def flips(judged, recorded=None):
    """What to tell where a verdict is not the recorded one; empty where all are."""
    if recorded is None:
        recorded = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}
    out = []
    for name, now in judged.items():
        before = recorded.get(name, {"verdict": "nothing recorded", "figure": ""})
        if now["verdict"] not in ("printed", before["verdict"]):
            out.append(f"rd.py: verdict \"{now['finding']}\" was: {before['verdict']} ({before['figure']}), "
                       f"is: {now['verdict']} ({now['figure']})")
    if out:
        out.append("rd.py: if this is meant, say why in the change and run: tools/rd/rd.py quick --slf ... --out ... --record")
    return out
