# SPDX-License-Identifier: Apache-2.0
"""Where captures come from: made by `slf synth`, in the data directory, or any directory.

A source is one of
    synth:SCENE[?size=N&points=N&circles=N&per-circle=N&supersampling=N]   made once, under OUT/captures
    data:NAME[?points=FILE]     a directory of the data directory (--data, SLF_DATA); skipped where absent
    PATH[?points=FILE]          any capture that slf reads, from the working directory
`points` names the cloud inside the capture in place of its own. captures.json gives names to sources.
"""
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
from urllib.parse import parse_qsl

from located_json import BadInput, load

HERE = pathlib.Path(__file__).resolve().parent
SYNTH_RANGES = {"size": (8, 4096), "points": (100, 10_000_000), "circles": (1, 99), "per-circle": (1, 360),
                "supersampling": (1, 8)}
# Captures without splits: every n-th of the images that are not for evaluation (paper IV-B, real data).
FRACTIONS = {"dense": "1/2", "intermediate": "1/4", "sparse": "1/8"}
FRACTION = re.compile(r"1/[1-9][0-9]{0,3}")


class Absent(Exception):
    """A capture of the data directory is not there; str() says so."""


def aliases():
    """Name to source, of captures.json."""
    return {name: item["source"] for name, item in load(HERE / "captures.json", "captures.json").plain().items()}


def parse_source(source, scenes):
    """(kind, place, options) of a source; ValueError says what is wrong with it."""
    kind, _, rest = source.partition(":")
    if kind not in ("synth", "data"):
        kind, rest = "path", source
    place, _, query = rest.partition("?")
    options = dict(parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query)))
    if kind == "synth":
        if place not in scenes:
            raise ValueError(f'no scene "{place}"; there are {", ".join(scenes)}')
        for key, text in options.items():
            if key not in SYNTH_RANGES:
                raise ValueError(f'synth has no "{key}"; it has {", ".join(SYNTH_RANGES)}')
            low, high = SYNTH_RANGES[key]
            if not (text.isdigit() and low <= int(text) <= high):
                raise ValueError(f"{key}={text}: a whole number {low} to {high} is expected")
    elif set(options) - {"points"}:
        raise ValueError(f'a directory takes "points" alone, not "{sorted(set(options) - {"points"})[0]}"')
    if not place:
        raise ValueError(f'"{source}" names nothing')
    return kind, place, options


def scenes_of(slf):
    """Names of the scenes that this slf can make."""
    done = subprocess.run([slf, "synth", "--list"], capture_output=True, text=True, check=True)
    return [line.split()[0] for line in done.stdout.splitlines() if line.split()]


def content_hash(directory, points):
    """SHA-256 over the names and bytes of all files of a capture, and which cloud is used."""
    digest = hashlib.sha256(f"points {points or ''}\n".encode())
    root = pathlib.Path(directory)
    files = sorted(p for p in root.rglob("*") if p.is_file()) if root.is_dir() else [root]
    for path in files:
        digest.update(f"{path.relative_to(root)} {path.stat().st_size}\n".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def synthesise(slf, slf_hash, place, options, captures):
    """Directory of a made capture; made where it is not there yet, under another name until complete."""
    arguments = [place]
    for key, value in sorted(options.items()):
        arguments += ["--" + key, f"{value}x{value}" if key == "size" else value]
    tag = hashlib.sha256(json.dumps([arguments, slf_hash]).encode()).hexdigest()[:12]
    directory = captures / f"{place}-{tag}"
    if not directory.exists():
        partial = captures / f"{place}-{tag}.partial"
        shutil.rmtree(partial, ignore_errors=True)
        captures.mkdir(parents=True, exist_ok=True)
        done = subprocess.run([slf, "synth", *arguments, "-o", str(partial), "--quiet"], capture_output=True, text=True)
        if done.returncode:
            raise BadInput(f"slf synth {' '.join(arguments)}: {done.stderr.strip()}")
        os.replace(partial, directory)
    return directory


def camera_file(directory):
    """cameras.json of a capture as a dict, or None where it has another layout."""
    path = pathlib.Path(directory) / "cameras.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def describe(directory, points):
    """What plans and rows keep of a capture."""
    cameras = camera_file(directory)
    splits = cameras.get("splits") if cameras else None
    names = [camera["image"] for camera in cameras["cameras"]] if cameras else []
    held_out = (splits or {}).get("evaluation") or names[3::4]
    return {"directory": str(pathlib.Path(directory).resolve()), "points": points,
            "hash": content_hash(directory, points and os.path.relpath(points, directory)),
            "splits": sorted(splits) if splits else None, "held_out": held_out}


def resolve(kind, place, options, slf, slf_hash, out, data):
    """describe() of a parsed source. Absent, or BadInput without a place."""
    if kind == "synth":
        return describe(synthesise(slf, slf_hash, place, options, pathlib.Path(out) / "captures"), None)
    if kind == "data":
        directory = pathlib.Path(data or "no data directory", place)
        if not data or not directory.is_dir():
            raise Absent(f"{place}: not in {data}" if data else f"{place}: no data directory (--data, SLF_DATA)")
    else:
        directory = pathlib.Path(place)
    points = options.get("points")
    if not directory.exists():
        raise BadInput(f'no capture at "{place}"')
    if points and not (directory / points).is_file():
        raise BadInput(f'no cloud "{points}" in "{place}"')
    return describe(directory, str((directory / points).resolve()) if points else None)


def split_of(capture, split):
    """The name slf knows a split by; ValueError where the capture has none of that name."""
    named = capture["splits"]
    if FRACTION.fullmatch(split) or split == "all" or (named is not None and split in named):
        return split
    if split in FRACTIONS and not named:
        return FRACTIONS[split]
    raise ValueError(f'no split "{split}"; the capture has {", ".join(named or FRACTIONS)}')
