# SPDX-License-Identifier: Apache-2.0
"""A run's tables and figures as one Markdown page with its pictures beside it, for the repository."""
import pathlib
import shutil

import report
import tables


def table(header, lines):
    rows = [header, ["---"] * len(header), *lines]
    return "".join("| " + " | ".join(str(cell).replace("|", "/") for cell in row) + " |\n" for row in rows) + "\n"


def verdict_table(judged):
    return table(["the paper says", "our data", "figures"], [[v["finding"], v["verdict"], v["figure"]] for v in judged.values()])


def write(directory, out, plan, rows, figures, judged):
    """DIRECTORY/README.md and the PNGs that it shows; what else is there stays."""
    directory = pathlib.Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    failed = sum(r["status"] != "ok" for r in rows)
    parts = ["# A run of the experiments, as it came out\n\n",
             "Written by `tools/rd/rd.py --markdown`; what it means is in [decision 031](../decisions/031-paper-experiments.md).\n\n",
             f"Program {plan['slf']['version']}, commit {plan['slf']['commit'] or 'unknown'}; {report.machine()}; {len(plan['jobs'])} encodes, "
             f"{failed} rows without a result. One thread each, two at a time.\n\n", report.STAND_INS + "\n\n", "## The paper's findings\n\n",
             verdict_table(judged)]
    found = tables.bd_tables(rows)
    if found:
        parts += ["## BD figures against IGC (HEVC low delay)\n\n", tables.BD_NOTE + "\n\n", *(table(*one) for one in found)]
    for experiment in plan["experiments"]:
        parts.append(f"## {experiment['label']} — {experiment['title']}\n\n" + (experiment["note"] + "\n\n" if experiment["note"] else ""))
        own = [row for row in rows if row["experiment"] == experiment["label"]]
        if experiment["figure"] in tables.OF_FIGURE:
            make, note = tables.OF_FIGURE[experiment["figure"]]
            parts.append((note + "\n\n" if note else "") + table(*make(own)))
        for files in figures.get(experiment["label"], []):
            shutil.copyfile(pathlib.Path(out) / files["png"], directory / pathlib.Path(files["png"]).name)
            parts.append(f"![{experiment['label']}]({pathlib.Path(files['png']).name})\n\n")
    (directory / "README.md").write_text("".join(parts), encoding="utf-8")
