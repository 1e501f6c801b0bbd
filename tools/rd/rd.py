#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The RD laboratory: runs experiments and writes their table, plots, verdicts and one report page.

    rd.py quick --slf build/bin/slf --out build/rd          small captures, minutes; what CI runs
    rd.py paper --slf build/bin/slf --out build/rd-paper    every experiment of the paper's section IV
    rd.py full  --slf build/bin/slf --out build/rd-paper    and those of the default preset, with what each tool is worth
    rd.py my_experiment.json ...                            any manifests (README.md)

Interrupted, it goes on where it was; run again, it reruns what changed. Exit code: 0 all well, 1 jobs
failed or a verdict flipped, 2 a manifest or an argument is refused (nothing ran).
"""
import argparse
import fcntl
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

import plan as planning
from located_json import BadInput
from options import coded_name
from run_job import write_json

HERE = pathlib.Path(__file__).resolve().parent
SETS = {"quick": ("quick",), "paper": ("experiments",), "full": ("experiments", "defaults")}


def arguments():
    parser = argparse.ArgumentParser(prog="rd.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("manifests", nargs="+", metavar="quick|paper|full|FILE", help="a set of this directory, or manifest files")
    add("--slf", default=os.environ.get("SLF_PROGRAM", "slf"), help="the program; default: SLF_PROGRAM, else slf")
    add("--out", default="build/rd", help="directory of all results; default: build/rd")
    add("--data", default=os.environ.get("SLF_DATA"), help="directory of captures named data:NAME; default: SLF_DATA")
    add("--tmc3", help="the G-PCC reference software; adds the codec tmc3 where a manifest names it")
    add("--cores", type=int, default=os.cpu_count(), help="jobs at a time, one thread each; default: all cores")
    add("--cluster", metavar="COMMAND", help="submit jobs with this, e.g. sbatch; --cores is then the jobs at a time")
    add("--dry-run", action="store_true", help="check and count, run nothing (captures are made)")
    add("--check", action="store_true", help="fail where a verdict differs from verdicts.json")
    add("--record", action="store_true", help="write the verdicts to verdicts.json")
    add("--markdown", metavar="DIR", help="also write tables and figures as a Markdown page into DIR")
    return parser.parse_args()


def files_of(names):
    """[(path, name in messages)] of sets and files."""
    out = []
    for name in names:
        found = [path for folder in SETS[name] for path in sorted((HERE / folder).glob("*.json"))] if name in SETS else [pathlib.Path(name)]
        out += [(path, os.path.relpath(path)) for path in found]
    return out


def lock(out):
    """Held until this process ends; two runs in one directory would take each other's files away."""
    file = open(out / ".lock", "w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise BadInput(f"{out}: another rd.py is at work there") from None
    return file


def lay_out(out, plan):
    """One directory per job and task. What failed before is tried again."""
    programs = {"slf": plan["slf"]["path"], "tmc3": plan["tmc3"], "threads": 1}
    items = [("jobs", "job.json", "row.json", plan["jobs"]), ("tasks", "task.json", "done.json", plan["tasks"])]
    left = {}
    for folder, given, result, entries in items:
        for key, entry in entries.items():
            directory = out / folder / key
            directory.mkdir(parents=True, exist_ok=True)
            extra = {"coded": str(out / "jobs" / entry["job"] / coded_name(plan["jobs"][entry["job"]]))} if folder == "tasks" else {}
            write_json(directory / given, entry | programs | extra)
            if (directory / result).exists() and json.loads((directory / result).read_text())["status"] != "ok":
                (directory / result).unlink()
            left[folder] = left.get(folder, 0) + (not (directory / result).exists())
    write_json(out / "plan.json", plan)
    return left


def snakemake(out, plan, options):
    """Exit code of the workflow. What it says goes to snakemake.log."""
    words = ["snakemake", "--snakefile", str(HERE / "Snakefile"), "--directory", str(out), "--keep-going", "--nolock",
             "--rerun-incomplete", "--rerun-triggers", "mtime", "--quiet", "rules"]
    if options.cluster:
        submit = options.cluster
        if submit == "sbatch":  # a bare job number, as snakemake wants it
            (out / "slurm").mkdir(exist_ok=True)
            submit = f"sbatch --parsable --cpus-per-task={{threads}} --output={shlex.quote(str(out))}/slurm/%j.log"
            words += ["--cluster-status", str(HERE / "slurm_status.sh")]
        words += ["--cluster", submit, "--jobs", str(options.cores), "--latency-wait", "60"]
    else:
        words += ["--cores", str(options.cores)]
    if not shutil.which("snakemake"):
        raise BadInput("snakemake is not installed (tools/setup.sh)")
    with open(out / "snakemake.log", "w") as log:
        process = subprocess.Popen(words, stdout=log, stderr=subprocess.STDOUT)
        while True:
            if sys.stderr.isatty():
                done = sum((out / "jobs" / key / "row.json").exists() for key in plan["jobs"])
                print(f"\rrd.py: {done} of {len(plan['jobs'])} encodes", end="", file=sys.stderr, flush=True)
            try:
                return process.wait(timeout=2)
            except subprocess.TimeoutExpired:
                pass
            except KeyboardInterrupt:
                process.terminate()  # lets the jobs at work finish
                process.wait()
                sys.exit("\nrd.py: interrupted; the same command goes on from here")


def failures(out, plan):
    """{reason: [log]} of every job and task without a result."""
    found = {}
    for folder, result in (("jobs", "row.json"), ("tasks", "done.json")):
        for key in plan[folder]:
            path = out / folder / key / result
            row = json.loads(path.read_text()) if path.exists() else {"status": "missing", "reason": "did not finish"}
            if row["status"] != "ok":
                found.setdefault(row["reason"], []).append(out / folder / key / "log.txt")
    return found


def finish(out, plan, options, seconds):
    """Table, plots, verdicts, report; then whether all is well."""
    import collect  # these need numpy and matplotlib; a refused manifest should not wait for them
    import markdown
    import plot
    import report
    import verdicts
    rows = collect.collect(out, plan)
    figures = plot.draw(out, plan, rows)
    judged = verdicts.judge(rows)
    write_json(out / "verdicts.json", judged)
    report.write(out, plan, rows, figures, judged, seconds)
    if options.markdown:
        markdown.write(options.markdown, out, plan, rows, figures, judged)
    for line in verdicts.lines(judged):
        print(line)
    print(f"rd.py: {out / 'report.html'}, {out / 'results.csv'}, {out / 'figures'}")
    if options.record:
        verdicts.record(judged)
        print(f"rd.py: recorded in {os.path.relpath(verdicts.RECORD)}")
    flipped = verdicts.flips(judged) if options.check else []
    for line in flipped:
        print(line, file=sys.stderr)
    return not flipped


def main():
    options = arguments()
    slf = shutil.which(options.slf)
    try:
        if not slf:
            raise BadInput(f"--slf {options.slf}: no such program")
        if (options.check or options.record) and options.manifests != ["quick"]:
            raise BadInput("--check and --record: the record is that of the quick run alone")
        if options.cores < 1:
            raise BadInput("--cores: at least 1 is needed")
        tmc3 = shutil.which(options.tmc3) if options.tmc3 else None
        if options.tmc3 and not tmc3:
            raise BadInput(f"--tmc3 {options.tmc3}: no such program")
        out = pathlib.Path(options.out).resolve()
        out.mkdir(parents=True, exist_ok=True)
        held = lock(out)
        plan = planning.make(files_of(options.manifests), slf, out, options.data, tmc3 and os.path.abspath(tmc3))
        left = lay_out(out, plan)
    except BadInput as error:
        print(f"rd.py: {error}", file=sys.stderr)
        return 2
    for note in plan["notes"]:
        print(f"rd.py: {note}", file=sys.stderr)
    print(f"rd.py: {len(plan['experiments'])} experiments, {len(plan['jobs'])} encodes of which {left.get('jobs', 0)} are to "
          f"be run, {len(plan['tasks'])} pictures of which {left.get('tasks', 0)}", file=sys.stderr)
    if options.dry_run:
        return 0
    start = time.monotonic()
    snakemake(out, plan, options)
    well = finish(out, plan, options, time.monotonic() - start)
    failed = failures(out, plan)
    for reason, logs in failed.items():
        more = f" and {len(logs) - 3} more" if len(logs) > 3 else ""
        print(f"rd.py: {len(logs)} failed: {reason} ({', '.join(map(str, logs[:3]))}{more})", file=sys.stderr)
    held.close()
    return 0 if well and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
