#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trained Gaussian splats as others code them: bytes and held-out pictures.

    splats.py CAPTURE A.ply ... --out DIR [--formats spz,sog]

Every PLY of splats (the layout of Kerbl et al. 2023, in the world of the capture's cameras) is coded as SPZ and as
SOG by @playcanvas/splat-transform, decoded to a PLY again, drawn (splat_render.py), and judged on the pictures held
out as `slf eval` judges (judge.py). DIR receives the files, splats.csv with a row for each, and FORMAT.csv with bytes
and PSNR for bd.py. A format whose program is not there is skipped by name; a file that fails leaves its row.
"""
import argparse
import concurrent.futures
import csv
import functools
import os
import pathlib
import shutil
import subprocess
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # --jobs says how many

import judge  # noqa: E402
import splat_render  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = HERE / "splat_transform"  # the version is its package.json's
FORMATS = {"spz": [], "sog": ["--gpu", "cpu"]}  # options of the program
COLUMNS = ("name", "format", "status", "reason", "splats", "bytes", "psnr", "ssim", "coverage", "psnr_all", "ssim_all", "seconds_encode",
           "seconds_decode")
BAD_INPUT = 2


class Absent(Exception):
    """The program is not there; str() is the reason."""


class Failed(Exception):
    """A file was not coded or not read; str() is the reason, one line."""


def converter(given):
    """Command line of splat-transform: the given one, or that of the package, installed where npm reaches it."""
    if given:
        if not shutil.which(given):
            raise Absent(f"no program {given}")
        return [given]
    for tool in ("node", "npm"):
        if not shutil.which(tool):
            raise Absent(f"{tool} is not there")
    program = PACKAGE / "node_modules" / ".bin" / "splat-transform"
    if not program.exists():
        words = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries", "1", "--prefix", str(PACKAGE)]
        done = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode or not program.exists():
            raise Absent(f"npm ci in {PACKAGE}: {last_line(done)}")
    return [str(program)]


def last_line(done):
    said = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
    return said[-1].strip() if said else "no message"


def run(words, result):
    """Seconds that a program took to write a file."""
    start = time.monotonic()
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode or not result.is_file():
        raise Failed(f"{pathlib.Path(words[0]).name}: exit code {done.returncode}: {last_line(done)}")
    return time.monotonic() - start


def code(program, format_, source, out):
    """(decoded PLY, row) of a PLY in one format."""
    coded, decoded = out / f"{source.stem}.{format_}", out / f"{source.stem}.{format_}.ply"
    encode = run([*program, "--overwrite", *FORMATS[format_], source, coded], coded)
    decode = run([*program, "--overwrite", coded, decoded], decoded)
    return decoded, {"bytes": coded.stat().st_size, "seconds_encode": round(encode, 2), "seconds_decode": round(decode, 2)}


@functools.cache
def loaded(capture, points, paths):
    """What a process needs for every picture."""
    return judge.Capture(capture, points), [splat_render.read_splats(path) for path in paths]


def judge_picture(capture, points, paths, name):
    """A Quality of one picture for every PLY."""
    read, splats = loaded(capture, points, paths)
    photograph = read.photograph(name)
    qualities = []
    for own in splats:
        picture, coverage = splat_render.render(own, read.cameras[name])
        qualities.append(judge.Quality())
        qualities[-1].add(*photograph, judge.to_bytes(picture), judge.to_bytes(coverage))
    return qualities


def judged(capture, points, names, paths, jobs):
    """A report of the pictures of these names for every PLY, in order."""
    of_picture = functools.partial(judge_picture, capture, points, tuple(paths))
    pooled = [judge.Quality() for _ in paths]
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        for qualities in pool.map(of_picture, names):
            for whole, part in zip(pooled, qualities):
                whole.include(part)
    return [quality.report() for quality in pooled]


def coded_rows(given, program, formats):
    """[(decoded PLY or None, row)] of all files and formats, the float originals among them."""
    rows = []
    for source in given.splats:
        try:
            count = len(splat_render.read_splats(source).positions)
        except (OSError, ValueError, KeyError) as error:
            rows.append((None, {"name": source.stem, "format": "float", "status": "failed", "reason": str(error)}))
            continue
        rows.append((source, {"name": source.stem, "format": "float", "splats": count, "bytes": source.stat().st_size}))
        for format_ in formats:
            row = {"name": source.stem, "format": format_, "splats": count}
            try:
                decoded, own = code(program, format_, source, given.out)
                rows.append((decoded, row | own))
            except Failed as error:
                rows.append((None, row | {"status": "failed", "reason": str(error)}))
    return rows


def measured_rows(given, held_out, formats, program):
    rows = coded_rows(given, program, formats)
    files = [path for path, _ in rows if path]
    reports = iter(judged(given.capture, given.points, held_out, files, given.jobs) if files else [])
    for path, row in rows:
        if path:
            report = next(reports)
            row |= {"status": "ok", "psnr": round(report["inside"]["psnr"], 3), "ssim": round(report["inside"]["ssim"], 4),
                    "coverage": round(report["coverage"], 4), "psnr_all": round(report["all"]["psnr"], 3),
                    "ssim_all": round(report["all"]["ssim"], 4)}
    return [row for _, row in rows]


def write_tables(rows, formats, out):
    with open(out / "splats.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    for format_ in formats:
        points = sorted((row["bytes"], row["psnr"]) for row in rows if row["format"] == format_ and row["status"] == "ok")
        (out / f"{format_}.csv").write_text("".join(f"{size},{psnr}\n" for size, psnr in points))


def print_table(rows):
    print(f"{'splats':24} {'format':6} {'number':>8} {'bytes':>11} {'inside':>9} {'SSIM':>6} {'all':>9} {'SSIM':>6}")
    for row in rows:
        if row["status"] == "ok":
            print(f"{row['name']:24} {row['format']:6} {row['splats']:8,} {row['bytes']:11,} {row['psnr']:6.2f} dB {row['ssim']:6.3f} "
                  f"{row['psnr_all']:6.2f} dB {row['ssim_all']:6.3f}")
        else:
            print(f"{row['name']:24} {row['format']:6} failed: {row['reason']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", help="a directory with cameras.json and a cloud with normals")
    parser.add_argument("splats", nargs="+", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--points", help="PLY cloud in place of the capture's own, for the masks")
    parser.add_argument("--formats", default=",".join(FORMATS), help="of %(default)s; the float originals are always judged")
    parser.add_argument("--splat-transform", help="the program; default: of npm, installed when it is first needed")
    parser.add_argument("--jobs", type=int, default=1, help="processes that draw")
    given = parser.parse_args()
    formats = [name for name in given.formats.split(",") if name]
    if unknown := set(formats) - set(FORMATS):
        parser.error(f'no format "{sorted(unknown)[0]}"; there are {", ".join(FORMATS)}')
    if len({path.stem for path in given.splats}) < len(given.splats):
        parser.error("two files have one name")
    if given.jobs < 1:
        parser.error("--jobs: a number from 1 is expected")
    try:
        held_out = judge.Capture(given.capture, given.points).held_out
    except (OSError, ValueError) as error:
        print(f"splats.py: {error}", file=sys.stderr)
        return BAD_INPUT
    given.out.mkdir(parents=True, exist_ok=True)
    program = None
    try:
        program = converter(given.splat_transform) if formats else None
    except Absent as error:
        print(f"skipped: {', '.join(formats)}: {error}", file=sys.stderr)
        formats = []
    rows = measured_rows(given, held_out, formats, program)
    write_tables(rows, formats, given.out)
    print_table(rows)
    return int(any(row["status"] != "ok" for row in rows))


if __name__ == "__main__":
    sys.exit(main())
