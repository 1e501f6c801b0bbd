# SPDX-License-Identifier: Apache-2.0
"""From manifests to a plan: every job once, under a key that changes with whatever changes its result."""
import hashlib
import itertools
import json
import os
import subprocess

import captures as cap
import manifest
import options as opt

JOB_VERSION = 1  # of what run_job.py measures; part of every key


def digest(value):
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]


def file_hash(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def program(slf):
    """Path, content hash, version of the program, and the commit of this repository where it is one."""
    version = subprocess.run([slf, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    git = ["git", "-C", str(cap.HERE), "describe", "--always", "--dirty", "--abbrev=12"]
    done = subprocess.run(git, capture_output=True, text=True)
    commit = done.stdout.strip() if done.returncode == 0 else ""
    return {"path": os.path.abspath(slf), "sha256": file_hash(slf), "version": version, "commit": commit}


def job_key(job, programs):
    """Hash over the resolved settings, the capture's content and the programs' content.

    The capture's place and the name of the manifest are no part of it: the same job asked for twice
    runs once, and a moved directory reruns nothing.
    """
    settings = {key: value for key, value in job.items() if key not in ("capture", "key")}
    used = programs if job["codec"] == "tmc3" else {"slf": programs["slf"]}
    return digest([JOB_VERSION, settings, job["capture"]["hash"], used])


def series(settings):
    """[(variant or None, preset, grid values, options of its own)] in the manifest's order."""
    presets = settings["presets"]
    if settings["variants"]:
        return [(name, own.get("preset", presets[0]), {}, own.get("options", {})) for name, own in settings["variants"].items()]
    grid = [dict(zip(settings["grid"], values)) for values in itertools.product(*settings["grid"].values())]
    return [(None, preset, values, values) for preset, values in itertools.product(presets, grid)]


class Planner:
    """Collects experiments; `plan` is what Snakefile, collect.py and the plots read."""

    def __init__(self, slf, out, data=None, tmc3=None):
        self.slf, self.out, self.data, self.tmc3 = slf, out, data, tmc3
        self.programs = {"slf": self.slf["sha256"]} | ({"tmc3": file_hash(tmc3)} if tmc3 else {})
        self.scenes, self.aliases = cap.scenes_of(slf["path"]), cap.aliases()
        self.resolved, self.wanted, self.notes = {}, [], []

    def parse(self, item):
        """The source of a capture named in a manifest; BadInput where there is none. Nothing is made yet."""
        try:
            parsed = cap.parse_source(self.aliases.get(item.value, item.value), self.scenes)
        except ValueError as error:
            raise item.refuse(f"capture {item.value}: {error}") from None
        if parsed[0] == "path" and not os.path.exists(parsed[1]):
            raise item.refuse(f"capture {item.value}: nothing is there, and captures.json has no such name")
        return parsed

    def resolve(self, item):
        """describe() of a capture, or None where the data directory lacks it."""
        if item.value not in self.resolved:
            try:
                self.resolved[item.value] = cap.resolve(*self.parse(item), self.slf["path"], self.slf["sha256"],
                                                        self.out, self.data)
            except cap.Absent as absent:
                self.notes.append(f"skipped: {absent}")
                self.resolved[item.value] = None
            except cap.BadInput as error:
                raise item.refuse(f"capture {item.value}: {error}") from None
        return self.resolved[item.value]

    def add(self, located, settings):
        """One experiment. BadInput where a capture or a split is missing."""
        points = []
        for item in located.value["captures"].value if "captures" in located.value else []:
            capture = self.resolve(item)
            if capture is None:
                continue
            if settings["view"] is not None and settings["view"] >= len(capture["held_out"]):
                raise located.value["view"].refuse(f'view {settings["view"]}: {item.value} has {len(capture["held_out"])} held-out images')
            for n, split in enumerate(settings["splits"]):
                try:
                    slf_split = cap.split_of(capture, split)
                except ValueError as error:
                    at = located.value["splits"].value[n] if "splits" in located.value else item
                    raise at.refuse(f"{item.value}: {error}") from None
                points += self.points(item.value, capture, split, slf_split, settings)
        self.wanted.append((settings, points))

    def points(self, name, capture, split, slf_split, settings):
        """Every (series, codec, rate) of one capture and split."""
        out = []
        for (variant, preset, values, given), codec in itertools.product(series(settings), settings["codecs"]):
            if codec == "tmc3" and not self.tmc3:
                note = "skipped: codec tmc3 (--tmc3)"
                self.notes += [note] if note not in self.notes else []
                continue
            options = {k: v for k, v in {**settings["options"], **given}.items()
                       if codec in opt.options()[k][1] and v is not False}  # a flag that is not given
            for rate in settings["rates"][codec]:
                job = {"codec": codec, "preset": preset, "options": options, "rate": rate, "slf_split": slf_split,
                       "deltas": settings["deltas"], "images": settings["images"] or settings["figure"] == "time",
                       "capture": {k: capture[k] for k in ("directory", "points", "hash")}}
                out.append({"capture": name, "split": split, "codec": codec, "preset": preset, "grid": values,
                            "variant": variant, "rate": rate, "job": job})
        return out

    def plan(self):
        """The whole plan as a JSON value; jobs that differ in `images` alone become one."""
        with_images = {job_key({**p["job"], "images": False}, self.programs)
                       for _, points in self.wanted for p in points if p["job"]["images"]}
        jobs, experiments, tasks = {}, [], {}
        for settings, points in self.wanted:
            for point in points:
                job = point["job"]
                job["images"] = job["images"] or job_key({**job, "images": False}, self.programs) in with_images
                point["job"] = job_key(job, self.programs)
                jobs[point["job"]] = job
            made = self.tasks(settings, points, tasks)
            experiments.append({**settings, "points": points, "tasks": made})
        return {"slf": self.slf, "tmc3": self.tmc3, "notes": self.notes, "jobs": jobs, "tasks": tasks,
                "captures": {k: v for k, v in self.resolved.items() if v}, "experiments": experiments}

    def tasks(self, settings, points, tasks):
        """What is made of coded files after their jobs: images, sheets, histograms."""
        made = []
        for point in points:
            capture = self.resolved[point["capture"]]
            if settings["figure"] == "views":
                what = {"kind": "image", "capture": capture["directory"], "image": capture["held_out"][settings["view"]]}
            elif settings["figure"] == "orbit":
                what = {"kind": "orbit", "views": settings["orbit"]}
            elif settings["figure"] == "histogram":
                what = {"kind": "histogram"}
            else:
                continue
            key = digest([JOB_VERSION, point["job"], {k: v for k, v in what.items() if k != "capture"}])
            tasks[key] = {**what, "job": point["job"]}
            made.append(key)
        return made


def make(files, slf, out, data=None, tmc3=None):
    """Plan of manifest files [(path, name)]. All manifests are checked before a capture is made."""
    planner = Planner(program(slf), out, data, tmc3)
    opt.load(slf)
    manifests = [manifest.read(path, name) for path, name in files]
    seen = {}
    for located, settings in manifests:
        if settings["label"] in seen:
            raise located.refuse(f'{settings["label"]} is also {seen[settings["label"]]}', "label")
        seen[settings["label"]] = located.path
        for item in located.value["captures"].value if "captures" in located.value else []:
            planner.parse(item)
    for located, settings in manifests:
        planner.add(located, settings)
    return planner.plan()
