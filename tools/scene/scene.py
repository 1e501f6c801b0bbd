#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Encodes a large scene in parts, side by side, by a workflow.

    scene.py CAPTURE -o scene.slf [--parts N] [--cores N] [--memory 2G] [--cluster sbatch] [--work DIR]
             [-- settings of slf encode]

Plan, parts, merge and check are one rule each of the Snakefile beside this. What is done is kept in DIR:
the same command goes on where an earlier one was ended, by Ctrl-C, a lost machine or a full disk, and
makes only what is missing. DIR must be on a disk that all machines see. Exit code 0 where the scene is
whole; 1 where parts failed, whose names and logs are printed.
"""
import argparse
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SLURM_STATUS = HERE.parent / "rd" / "slurm_status.sh"


def arguments(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("capture", help="as of slf encode")
    add("-o", "--output", required=True, help="the .slf file")
    add("--parts", type=int, default=4, help="parts of about as many points, 1 to 4096 (4)")
    add("--cores", type=int, default=os.cpu_count(), help="of this machine; with --cluster jobs at a time")
    add("--threads", type=int, default=1, help="of each part (1)")
    add("--memory", default="2G", help="of each part (2G)")
    add("--cluster", metavar="COMMAND", help="submit parts with this, e.g. sbatch")
    add("--work", metavar="DIR", help="for plan, parts and logs (OUTPUT.work)")
    add("--retries", type=int, default=1, help="of a part that failed (1)")
    add("--allow-missing", action="store_true", help="where parts fail for good, join the others")
    add("--slf", default=shutil.which("slf") or str(HERE.parents[1] / "build/bin/slf"), help="the program")
    settings = words[words.index("--") + 1:] if "--" in words else []
    given = parser.parse_args(words[:words.index("--")] if "--" in words else words)
    given.settings = settings
    if not 1 <= given.parts <= 4096:
        parser.error("--parts: 1 to 4096")
    return given


def job_of(given):
    return {"slf": str(pathlib.Path(given.slf).resolve()), "capture": str(pathlib.Path(given.capture).resolve()),
            "parts": given.parts, "threads": given.threads, "memory": given.memory, "retries": given.retries,
            "settings": shlex.join(given.settings)}


def write_job(work, job):
    """The job of this directory; another capture or other settings want a directory of their own."""
    file = work / "scene.json"
    text = json.dumps(job, indent=1)
    if file.exists():
        before = json.loads(file.read_text(encoding="utf-8"))
        for key in ("capture", "settings", "parts"):
            if before[key] != job[key]:
                sys.exit(f"scene.py: {work} is of another scene: {key} was {before[key]!r}")
        if file.read_text(encoding="utf-8") == text:
            return
    file.write_text(text, encoding="utf-8")


def done_parts(given, work):
    return sum((work / f"parts/part-{part}.slf").exists() for part in range(1, given.parts + 1))


def run(words, given, work):
    """Exit code of the workflow, whose messages go to a log; a count of parts on a terminal."""
    if not shutil.which(words[0]):
        sys.exit("scene.py: snakemake is not installed (tools/setup.sh lab)")
    with open(work / "snakemake.log", "w", encoding="utf-8") as log:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        while True:
            if sys.stderr.isatty():
                print(f"\rscene.py: {done_parts(given, work)} of {given.parts} parts", end="", file=sys.stderr, flush=True)
            try:
                code = process.wait(timeout=1)
                break
            except subprocess.TimeoutExpired:
                pass
            except KeyboardInterrupt:
                process.terminate()
                process.wait()
                sys.exit("\nscene.py: interrupted; the same command goes on from here")
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return code


def snakemake(given, work):
    words = ["snakemake", "--snakefile", str(HERE / "Snakefile"), "--directory", str(work), "--cores", str(given.cores),
             "--keep-going", "--rerun-incomplete", "--rerun-triggers", "mtime", "--nolock"]
    if given.cluster:
        logs = work / "slurm"
        logs.mkdir(exist_ok=True)
        command = given.cluster
        if os.path.basename(command.split()[0]) == "sbatch":
            command += f" --parsable --cpus-per-task={{threads}} --job-name=slf-{{rule}} --output={logs}/%j.out"
            words += ["--cluster-status", str(SLURM_STATUS)]
        words += ["--cluster", command, "--jobs", str(given.cores), "--latency-wait", "60"]
    return run(words, given, work)


def tail(file):
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines() if file.exists() else []
    return lines[-1] if lines else "no log"


def summary(given, work):
    """What became of the plan and the parts. -> those that are missing"""
    missing = []
    if not (work / "plan.json").exists():
        said = [line for line in (work / "snakemake.log").read_text(encoding="utf-8", errors="replace").splitlines()
                if line.startswith("slf: ")]
        print("plan: missing: " + (said[-1] if said else "see snakemake.log"))
        return list(range(1, given.parts + 1))
    for part in range(1, given.parts + 1):
        done = work / f"parts/part-{part}.slf"
        if not done.exists():
            missing.append(part)
        print(f"part {part}/{given.parts}: " + (f"{done.stat().st_size:,} bytes" if done.exists()
                                                else "missing: " + tail(work / f"parts/part-{part}.log")))
    return missing


def finish(given, work, missing):
    scene = work / "scene.slf"
    if missing:
        scene.unlink(missing_ok=True)
    there = [str(work / f"parts/part-{p}.slf") for p in range(1, given.parts + 1) if p not in missing]
    if missing and given.allow_missing and there:
        subprocess.run([given.slf, "merge", *there, "-o", str(scene), "--allow-missing", "--quiet"], check=True)
    if not scene.exists():
        return False
    shutil.copyfile(scene, given.output + ".tmp")
    os.replace(given.output + ".tmp", given.output)
    print(f"{given.output}: {os.path.getsize(given.output):,} bytes" + (", partial" if missing else ""))
    return True


def main(words):
    given = arguments(words)
    work = pathlib.Path(given.work or given.output + ".work").resolve()
    (work / "parts").mkdir(parents=True, exist_ok=True)
    write_job(work, job_of(given))
    failed = snakemake(given, work)
    missing = summary(given, work)
    made = finish(given, work, missing)
    if failed or missing or not made:
        sys.exit(f"scene.py: not whole; the same command goes on from what is in {work}")


if __name__ == "__main__":
    main(sys.argv[1:])
