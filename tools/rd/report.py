# SPDX-License-Identifier: Apache-2.0
"""One self-contained HTML page of a run: no script, no external resource, pictures inline."""
import base64
import html
import os
import pathlib
import platform
import re

import tables

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #1c2126; background: #fff; max-width: 1180px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.6em; margin-bottom: .2em } h2 { font-size: 1.15em; margin-top: 2em; border-bottom: 1px solid #d5dae0; padding-bottom: .2em }
table { border-collapse: collapse; font-size: 13px; margin: .6em 0 }
th, td { border: 1px solid #d5dae0; padding: .25em .5em; text-align: left; vertical-align: top }
th { background: #f2f4f7 } td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
img { max-width: 100%; display: block; margin: .6em 0 } .scroll { overflow-x: auto } .note { color: #57606a }
.agrees { color: #11703a; font-weight: 600 } .contradicts { color: #a3261b; font-weight: 600 } .undecided, .printed { color: #7a5a00; font-weight: 600 }
code { font-size: 90% } summary { cursor: pointer; color: #1f5fa8 }
"""
STAND_INS = ("The paper's real captures, Elephant and Fish (Wood et al. 2000), are not to be had. blender_can (Blender Cycles, the "
             "paper's Can arrangement) and middlebury_dino (photographs of a dinosaur; Seitz et al. 2006) stand in for them; whoever "
             "has the raw data puts it into DATA/elephant and DATA/fish. The "
             "paper's meshes are not to be had either: synthetic Can and Die are those of slf synth, so decibels cannot be compared "
             "with the paper's; shapes of curves can.")


def text(value):
    return html.escape(str(value))


def is_number(value):
    return re.fullmatch(r"[+-]?[0-9.,]+( ?[kM]?B| ?%)?", value) is not None


def table(header, lines):
    head = "".join(f"<th>{text(h)}</th>" for h in header)
    body = "".join("<tr>" + "".join(f'<td class="n">{text(c)}</td>' if is_number(c) else f"<td>{text(c)}</td>" for c in line) + "</tr>\n"
                   for line in lines)
    return f'<div class="scroll"><table><tr>{head}</tr>\n{body}</table></div>\n'


def picture(out, files, label):
    data = base64.b64encode((pathlib.Path(out) / files["png"]).read_bytes()).decode()
    return f'<img alt="{text(label)}" src="data:image/png;base64,{data}">\n'


def machine():
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "") \
        if os.path.exists("/proc/cpuinfo") else ""
    return f"{model or platform.processor() or platform.machine()}, {os.cpu_count()} cores, {platform.system()} {platform.release()}"


def head(plan, rows, seconds):
    failed = [r for r in rows if r["status"] != "ok"]
    facts = [["program", f"{plan['slf']['version']} (sha256 {plan['slf']['sha256'][:16]})"], ["commit", plan["slf"]["commit"] or "unknown"],
             ["machine", machine()],
             ["experiments", f"{len(plan['experiments'])}, {len(plan['jobs'])} encodes, {len({r['job'] for r in failed})} of them without a result"],
             ["time of this run", f"{seconds:.0f} s (what was done already is not run again)"],
             ["threads", "1 per encode and decode; several encodes at a time, so times are of a busy machine"],
             ["captures", "; ".join(f"{name}: {c['hash'][:12]}" for name, c in plan["captures"].items())]]
    notes = "".join(f"<li>{text(note)}</li>" for note in [STAND_INS, *plan["notes"]])
    return f"<h1>SLF: the experiments of the paper's section IV</h1>\n{table(['', ''], facts)}<ul class='note'>{notes}</ul>\n"


def verdict_section(judged):
    lines = "".join(f'<tr><td>{text(v["finding"])}</td><td class="{v["verdict"]}">{text(v["verdict"])}</td><td>{text(v["figure"])}</td>'
                    f'<td class="note">{text(v["rule"])}</td></tr>\n' for v in judged.values())
    return ("<h2>The paper's findings on our data</h2>\n<div class='scroll'><table><tr><th>finding</th><th>verdict</th><th>figures</th>"
            f"<th>rule</th></tr>\n{lines}</table></div>\n")


def bd_section(rows):
    found = tables.bd_tables(rows)
    if not found:
        return ""
    return f"<h2>BD figures against IGC (HEVC low delay)</h2>\n<p class='note'>{text(tables.BD_NOTE)}</p>\n" + \
        "".join(table(*one) for one in found)


def experiment_section(out, experiment, rows, figures):
    parts = [f"<h2 id='{text(experiment['label'])}'>{text(experiment['label'])} — {text(experiment['title'])}</h2>\n"]
    if experiment["note"]:
        parts.append(f"<p class='note'>{text(experiment['note'])}</p>\n")
    if experiment["figure"] in tables.OF_FIGURE:
        make, note = tables.OF_FIGURE[experiment["figure"]]
        parts.append((f"<p class='note'>{text(note)}</p>\n" if note else "") + table(*make(rows)))
    parts += [picture(out, files, experiment["label"]) for files in figures]
    if experiment["captures"] and not rows:
        parts.append("<p>Skipped: no capture of it is here.</p>\n")
    if rows:
        parts.append(f"<details><summary>{len(rows)} rows</summary>{table(*tables.row_table(rows))}</details>\n")
    return "".join(parts)


def write(out, plan, rows, figures, judged, seconds):
    """OUT/report.html. `seconds` is the time of this run's jobs."""
    body = [head(plan, rows, seconds), verdict_section(judged), bd_section(rows)]
    for experiment in plan["experiments"]:
        own = [row for row in rows if row["experiment"] == experiment["label"]]
        body.append(experiment_section(out, experiment, own, figures.get(experiment["label"], [])))
    page = (f"<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>SLF experiments</title><style>{STYLE}</style></head>"
            f"<body>\n{''.join(body)}</body></html>\n")
    (pathlib.Path(out) / "report.html").write_text(page, encoding="utf-8")
