#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs one job: encode, measure, write row.json. run_job.py DIR, which holds job.json.

A job that fails leaves a row with status "failed" and the reason, and log.txt beside it; the exit code
is 0 all the same, so that a workflow goes on with the others (rd.py names the failed ones at its end).
"""
import json
import os
import pathlib
import subprocess
import sys
import time
import traceback

import options as opt


class Failed(Exception):
    """The job has no result; str() is the reason, one line."""


def write_json(path, value):
    """Complete or not at all: an interrupted run leaves no half row."""
    partial = f"{path}.partial"
    with open(partial, "w", encoding="utf-8") as file:
        json.dump(value, file, indent=1)
    os.replace(partial, path)


def run(words, log):
    """Standard output of a program. Command, messages and exit code go to the log."""
    log.write("$ " + " ".join(words) + "\n")
    log.flush()
    start = time.monotonic()
    try:
        done = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    except OSError as error:
        raise Failed(f"{words[0]}: {error.strerror}") from None
    log.write(done.stderr)
    log.write(f"[exit code {done.returncode}, {time.monotonic() - start:.2f} s]\n")
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if line.strip()]
        raise Failed(f"{os.path.basename(words[0])} {words[1]}: exit code {done.returncode}: {said[-1] if said else 'no message'}")
    return done.stdout


def report(text, verb):
    try:
        return json.loads(text)
    except ValueError:
        raise Failed(f"{verb} printed no JSON") from None


def measure(directory, job, log):
    """{"encode": report, "eval": report} of one job."""
    if job["codec"] == "tmc3":
        import tmc3  # needs numpy, which the other jobs do without
        return tmc3.measure(directory, job, lambda words: run(words, log))
    coded = str(directory / opt.coded_name(job))
    encoded = report(run(opt.encode_command(job["slf"], job, coded, job["threads"]), log), "encode")
    measured = report(run(opt.eval_command(job["slf"], job, coded, job["threads"]), log), "eval")
    return {"encode": encoded, "eval": measured}


def main(directory):
    directory = pathlib.Path(directory)
    job = json.loads((directory / "job.json").read_text(encoding="utf-8"))
    row = {"key": directory.name, "job": job, "status": "failed", "reason": ""}
    with open(directory / "log.txt", "w", encoding="utf-8") as log:
        try:
            row |= measure(directory, job, log) | {"status": "ok"}
        except Failed as error:
            row["reason"] = str(error)
            log.write(f"failed: {error}\n")
        except Exception:  # a mistake in here must not take the other jobs down either
            row["reason"] = traceback.format_exc().splitlines()[-1]
            traceback.print_exc(file=log)
    write_json(directory / "row.json", row)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
