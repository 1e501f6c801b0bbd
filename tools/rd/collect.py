# SPDX-License-Identifier: Apache-2.0
"""results.csv: one row per experiment and encode."""
import csv
import json
import pathlib

COLUMNS = ["experiment", "title", "capture", "split", "codec", "preset", "variant", "rate", "status", "reason", "key",
           "input_hash", "commit", "program", "points", "cameras", "bytes"]


def load_rows(out, plan):
    """Rows of all points of all experiments, as dicts with the job's reports under "encode" and "eval"."""
    rows, results = [], {}
    for key in plan["jobs"]:
        path = pathlib.Path(out) / "jobs" / key / "row.json"
        results[key] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else \
            {"status": "missing", "reason": "did not finish"}
    for experiment in plan["experiments"]:
        for point in experiment["points"]:
            result = results[point["job"]]
            rows.append({"experiment": experiment["label"], "title": experiment["title"], **point,
                         "options": plan["jobs"][point["job"]]["options"], "status": result["status"],
                         "reason": result["reason"], "encode": result.get("encode") or {}, "eval": result.get("eval") or {},
                         "input_hash": plan["jobs"][point["job"]]["capture"]["hash"],
                         "commit": plan["slf"]["commit"], "program": plan["slf"]["sha256"][:16]})
    return rows


def psnr(row, cameras="held_out", delta=10, key="psnr"):
    """Point PSNR in dB of "input" or "held_out" cameras at an evaluation angle; None where not measured."""
    for point in (row["eval"].get(cameras) or {}).get("points", []):
        if point["delta"] == delta:
            return point[key]
    return None


def image_psnr(row, cameras="held_out", delta=None):
    """PSNR in dB of rendered images where both show the object; None where not measured. Has no evaluation angle."""
    return ((row["eval"].get(cameras) or {}).get("image") or {}).get("psnr")


def size(row):
    return row["eval"].get("bytes")


def size_without_geometry(row):
    """Bytes of the file less those of the geometry unit; None where they are not told apart."""
    geometry = (row["eval"].get("bytes_by_type") or {}).get("geometry")
    return None if geometry is None else size(row) - geometry


def leaves(value, name=""):
    """(name, number) of nested objects, names joined by _; lists are left out."""
    for key, part in value.items():
        if isinstance(part, dict):
            yield from leaves(part, f"{name}{key}_")
        elif not isinstance(part, list):
            yield name + key, part


def seconds_columns(row):
    out = {f"encode_s.{stage}": value for stage, value in row["encode"].get("seconds", {}).items()}
    for stage, value in (row["eval"].get("decode") or {}).items():
        out["decode_threads" if stage == "threads" else f"decode_s.{stage}"] = value
    out["render_s_per_image"] = (row["eval"].get("render") or {}).get("seconds_per_image")
    return out


def flat(row):
    """One row as the table has it: no nesting, one name per column."""
    out = {key: row.get(key) for key in ("experiment", "title", "capture", "split", "codec", "preset", "variant", "rate",
                                         "status", "reason", "input_hash", "commit", "program")}
    out |= {"key": row["job"], "points": row["eval"].get("points"), "cameras": row["encode"].get("cameras"), "bytes": size(row)}
    settings = row["encode"].get("settings") or row["eval"].get("settings") or {}
    out |= {"set." + key.replace("_", "-"): value for key, value in {**row["options"], **settings}.items()}
    out |= {f"bytes.{unit}": value for unit, value in row["eval"].get("bytes_by_type", {}).items()}
    for cameras in ("input", "held_out"):
        part = row["eval"].get(cameras) or {}
        out[f"{cameras}.cameras"] = part.get("cameras")
        for point in part.get("points", []):
            out[f"{cameras}.psnr.{point['delta']:g}"] = point["psnr"]
            out[f"{cameras}.luma_psnr.{point['delta']:g}"] = point.get("luma_psnr")
        out |= {f"{cameras}.image_{key}": value for key, value in leaves(part.get("image") or {})}
    out |= seconds_columns(row)
    out["peak_memory_mib"] = row["encode"].get("peak_memory_mib")
    return out


def collect(out, plan):
    """load_rows(), after writing results.csv."""
    rows = load_rows(out, plan)
    table = [flat(row) for row in rows]
    names = sorted({name for line in table for name in line} - set(COLUMNS))
    with open(pathlib.Path(out) / "results.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS + names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)
    return rows
