#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes one picture or histogram of a coded file: run_task.py DIR, which holds task.json.

Writes done.json {"status", "reason", "files" or "counts"}; never fails (see run_job.py).
"""
import json
import pathlib
import shutil
import sys
import traceback

from run_job import Failed, run, write_json

# Components are counted by the magnitude of the coefficient in grey levels, in these bins.
EDGES = [0, 0.5] + [0.5 * 2 ** (i / 2) for i in range(1, 21)]


def image(directory, task, log):
    """The capture's view as rendered."""
    run([task["slf"], "render", task["coded"], "--capture", task["capture"], "--image", task["image"], "--threads",
         str(task["threads"]), "--quiet", "-o", str(directory / "view.png")], log)
    return {"files": ["view.png"], "photograph": str(pathlib.Path(task["capture"]) / task["image"])}


def orbit(directory, task, log):
    run([task["slf"], "render", task["coded"], "--orbit", str(task["views"]), "--sheet", "--size", "240x240", "--threads",
         str(task["threads"]), "--quiet", "-o", str(directory / "sheet.png")], log)
    return {"files": ["sheet.png"]}


def histogram(directory, task, log):
    """Counts of |coefficient| per bin, of the constant function and of all others, over all channels."""
    import numpy as np
    dump = directory / "dump"
    run([task["slf"], "decode", task["coded"], "--dump", str(dump), "--threads", str(task["threads"]), "--quiet"], log)
    field = json.loads((dump / "light_field.json").read_text())
    components = np.load(dump / "components.npy", mmap_mode="r")
    sizes = np.abs(components) / 2.0 ** np.array(field["shift"])[None, :, None]
    edges = np.array(EDGES + [np.inf])
    counts = {name: np.histogram(part, edges)[0].tolist() for name, part in (("constant", sizes[:, :1]), ("others", sizes[:, 1:]))}
    zero = float((components == 0).mean())
    shutil.rmtree(dump)
    return {"edges": EDGES, "counts": counts, "zero": zero}


def main(directory):
    directory = pathlib.Path(directory)
    task = json.loads((directory / "task.json").read_text(encoding="utf-8"))
    done = {"status": "failed", "reason": ""}
    with open(directory / "log.txt", "w", encoding="utf-8") as log:
        try:
            row = json.loads((directory.parent.parent / "jobs" / task["job"] / "row.json").read_text(encoding="utf-8"))
            if row["status"] != "ok":
                raise Failed(f"its job failed: {row['reason']}")
            done |= {"image": image, "orbit": orbit, "histogram": histogram}[task["kind"]](directory, task, log) | {"status": "ok"}
        except Failed as error:
            done["reason"] = str(error)
            log.write(f"failed: {error}\n")
        except Exception:
            done["reason"] = traceback.format_exc().splitlines()[-1]
            traceback.print_exc(file=log)
    write_json(directory / "done.json", done)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
