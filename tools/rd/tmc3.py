# SPDX-License-Identifier: Apache-2.0
"""The G-PCC reference software (TMC13) as a codec: geometry, and every coefficient plane as 8 bits.

The program takes one 8-bit attribute per run, so a file of N functions is 1 + 3 N runs. Counted are the
geometry file, the attribute units of every run and the scale: one step for all planes (the paper's
uniform rescaling), one offset each. Nothing of ours codes anything.

The result has no file that `slf eval` reads, so PSNR is an estimate: squared error of the fit, as
`slf eval` measures it on an encode at Q = 1, plus squared error of the coded planes along the directions
of the held-out cameras, without occlusion and clamping. Tried on files of SLF-RAHT, whose PSNR is known,
it is right to 0.1 dB. On input cameras it would be up to 1 dB too good (the fit's residual there is not
independent of the coding error), so there is none. Rows say so: settings.psnr = "estimated".
"""
import json
import pathlib
import shutil
import struct
import sys
import time

import numpy as np
from scipy.spatial import cKDTree

import options as opt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/examples"))
from radiance import wavelet  # noqa: E402  (spec 6.3)

GEOMETRY = ("--mode=0 --trisoupNodeSizeLog2=0 --mergeDuplicatedPoints=0 --neighbourAvailBoundaryLog2=8 "
            "--intra_pred_max_node_size_log2=6 --positionQuantizationScale=1 --inferredDirectCodingMode=1 "
            "--maxNumQtBtBeforeOt=4 --minQtbtSizeLog2=0 --planarModeIdcmUse=0 --planarEnabled=0").split()
ATTRIBUTE = ("--transformType=0 --rahtPredictionSearchRange=50000 --bitdepth=8 --attrOffset=0 --attrScale=1").split()
ATTRIBUTE_UNITS = (3, 4)  # parameter set and brick, types of the TLV units of a stream
FINE = 1.0                # Q of the encode that stands for the fit itself, grey levels
LEVELS = 255
SAMPLED_POINTS, SAMPLED_CAMERAS = 800, 24
PLY_TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1", "ushort": "<u2",
             "uint16": "<u2", "int": "<i4", "uint": "<u4"}


def write_ply(path, positions, plane=None):
    fields = [(axis, "<f4") for axis in "xyz"] + ([("reflectance", "<u2")] if plane is not None else [])
    rows = np.zeros(len(positions), fields)
    for i, axis in enumerate("xyz"):
        rows[axis] = positions[:, i]
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n" + "".join(f"property float {a}\n" for a in "xyz")
    if plane is not None:
        rows["reflectance"] = plane
        header += "property uint16 reflectance\n"
    pathlib.Path(path).write_bytes(header.encode() + b"end_header\n" + rows.tobytes())


def read_ply(path):
    """{property: values}; vertices alone, ASCII or little endian."""
    with open(path, "rb") as file:
        fields, count, ascii_, element = [], 0, False, ""
        while (words := file.readline().decode().split()) != ["end_header"]:
            if not words:
                raise ValueError(f"{path}: no end_header")
            ascii_ |= words[:2] == ["format", "ascii"]
            if words[0] == "element":
                element = words[1]
                count = int(words[2]) if element == "vertex" else count
            elif words[0] == "property" and element == "vertex":
                fields.append((words[2], PLY_TYPES[words[1]]))
        if ascii_:
            rows = np.loadtxt(file, max_rows=count, ndmin=2)
            return {name: rows[:, i] for i, (name, _) in enumerate(fields)}
        rows = np.frombuffer(file.read(), fields, count)
        return {name: rows[name] for name, _ in fields}


def units(stream):
    """[(type, bytes with its 5 of header)] of a TLV stream."""
    out, at = [], 0
    while at + 5 <= len(stream):
        kind, size = stream[at], struct.unpack(">I", stream[at + 1:at + 5])[0]
        out.append((kind, 5 + size))
        at += 5 + size
    if at != len(stream):
        raise ValueError("the stream ends within a unit")
    return out


def rank(positions):
    """Row order by coordinates; decoders give points in another order."""
    return np.lexsort(np.asarray(positions, np.int64).T)


class Coder:
    """Runs of the program in one directory."""

    def __init__(self, program, directory, run):
        self.program, self.directory, self.run = program, directory, run
        directory.mkdir(exist_ok=True)

    def code(self, positions, plane=None, qp=None):
        """(stream, decoded plane or None, seconds of encoding, of decoding)."""
        ply, stream, decoded = (str(self.directory / name) for name in ("in.ply", "x.bin", "out.ply"))
        write_ply(ply, positions, plane)
        attribute = ["--disableAttributeCoding=1"] if plane is None else [*ATTRIBUTE, f"--qp={qp}", "--attribute=reflectance"]
        start = time.monotonic()
        self.run([self.program, *GEOMETRY, *attribute, f"--uncompressedDataPath={ply}", f"--compressedStreamPath={stream}"])
        middle = time.monotonic()
        self.run([self.program, "--mode=1", f"--compressedStreamPath={stream}", f"--reconstructedDataPath={decoded}"])
        end = time.monotonic()
        back = read_ply(decoded)
        place = np.stack([back[axis] for axis in "xyz"], 1)
        order, mine = rank(np.round(place)), rank(positions)
        if len(place) != len(positions) or (np.round(place)[order] != positions[mine]).any():
            raise ValueError("tmc3 did not give the points back")
        values = None
        if plane is not None:
            name = next(n for n in back if n not in "xyz")
            values = np.empty(len(positions))
            values[mine] = back[name][order]
        return pathlib.Path(stream).read_bytes(), values, middle - start, end - middle


def code_planes(coder, positions, coefficients, qp):
    """(bytes by unit, decoded coefficients, seconds {stage: [encode, decode]}). coefficients: [P, K, 3]."""
    flat = coefficients.reshape(len(positions), -1)
    low = flat.min(0)
    step = max(float((flat.max(0) - low).max()) / LEVELS, 1e-9)
    stream, _, *seconds = coder.code(positions)
    sizes = {"geometry": len(stream), "coefficients": 0, "parameters": 4 + 4 * flat.shape[1]}
    times = {"geometry": seconds, "coefficients": [0.0, 0.0]}
    out = np.repeat(low[None], len(flat), 0)
    for k in range(flat.shape[1]):
        plane = np.round((flat[:, k] - low[k]) / step).astype(np.uint16)
        if plane.any():
            stream, values, encode, decode = coder.code(positions, plane, qp)
            sizes["coefficients"] += sum(size for kind, size in units(stream) if kind in ATTRIBUTE_UNITS)
            out[:, k] += values * step
            times["coefficients"] = [times["coefficients"][0] + encode, times["coefficients"][1] + decode]
    return sizes, out.reshape(coefficients.shape), times


def held_out_centres(directory, split):
    """World positions [C, 3] of the cameras that are held out of a split."""
    capture = json.loads((pathlib.Path(directory) / "cameras.json").read_text(encoding="utf-8"))
    splits, names = capture.get("splits") or {}, [camera["image"] for camera in capture["cameras"]]
    held_out = set(splits.get("evaluation") or names[3::4]) - set(splits.get(split) or [])
    return np.array([-np.array(c["R"]).T @ np.array(c["t"]) for c in capture["cameras"] if c["image"] in held_out])


def normals_at(cloud, world):
    """Unit normals [P, 3] of the nearest points of the capture's cloud; None where it has none."""
    ply = read_ply(cloud)
    if "nx" not in ply:
        return None
    nearest = cKDTree(np.stack([ply[a] for a in "xyz"], 1)).query(world)[1]
    return np.stack([ply[a] for a in ("nx", "ny", "nz")], 1)[nearest]


def mean_square_error(field, positions, error, centres, normals=None):
    """Error of colours along directions to cameras up to 80 degrees from the normal, grey levels squared; sampled."""
    pick = np.random.default_rng(1)
    rows = pick.permutation(len(positions))[:SAMPLED_POINTS]
    centres = centres[pick.permutation(len(centres))[:SAMPLED_CAMERAS]]
    world = np.array(field["grid"]["origin"]) + field["grid"]["step"] * positions[rows]
    to_eye = centres[:, None] - world[None]
    to_eye /= np.linalg.norm(to_eye, axis=2, keepdims=True)
    theta = np.arctan2(to_eye[..., 1], to_eye[..., 0]) / (2 * np.pi) % 1
    gamma = np.clip(to_eye[..., 2], *field["gamma_range"]) / 2 % 1
    basis, grid = field["basis"], np.arange(513) / 512
    tables = [np.array([[wavelet(basis["order"], i, x) for x in grid] for i in range(2 ** basis[s])])
              for s in ("scales_theta", "scales_gamma")]
    azimuth, elevation = ([np.interp(x, grid, t) for t in table] for x, table in zip((theta, gamma), tables))
    values = np.einsum("jcp,icp->cpji", np.array(elevation), np.array(azimuth)).reshape(*theta.shape, -1)
    colour = np.einsum("cpk,pkd->cpd", values, error[rows]) @ np.array(field["colour"]["to_rgb"]).T
    seen = np.ones(theta.shape, bool) if normals is None else np.einsum("cpd,pd->cp", to_eye, normals[rows]) > np.sin(np.radians(10))
    return float((colour[seen] ** 2).mean()) if seen.any() else 0.0


def with_error(quality, added):
    """A camera set's report of `slf eval` with `added` to the squared error of its point PSNRs."""
    if not quality:
        return quality
    points = [{"delta": p["delta"], "psnr": 10 * np.log10(255 ** 2 / (255 ** 2 / 10 ** (p["psnr"] / 10) + added)),
               "observations": p.get("observations")} for p in quality["points"]]
    return {"cameras": quality["cameras"], "points": points, "image": None}


def measure(directory, job, run):
    """{"encode", "eval"} of a job, as run_job.py keeps them."""
    coded, dump, threads = str(directory / "coded.slf"), directory / "dump", job["threads"]
    fine = {**job, "codec": "raht", "rate": FINE, "images": False}
    encoded = json.loads(run(opt.encode_command(job["slf"], fine, coded, threads)))
    measured = json.loads(run(opt.eval_command(job["slf"], fine, coded, threads)))
    run([job["slf"], "decode", coded, "--dump", str(dump), "--threads", str(threads), "--quiet"])
    field = json.loads((dump / "light_field.json").read_text())
    if field["basis"].get("id", "bspline") != "bspline" or field.get("directions", "world") != "world":
        raise ValueError("the PSNR of tmc3 is estimated for B-splines of directions of the world alone")
    positions = np.load(dump / "positions.npy")
    coefficients = np.load(dump / "components.npy") / 2.0 ** np.array(field["shift"])[None, :, None]
    coder = Coder(job["tmc3"], directory / "runs", run)
    sizes, decoded, times = code_planes(coder, positions, coefficients, job["rate"])
    world = np.array(field["grid"]["origin"]) + field["grid"]["step"] * positions
    place = pathlib.Path(job["capture"]["directory"])
    normals = normals_at(job["capture"]["points"] or place / "points.ply", world)
    centres = held_out_centres(place, job["slf_split"])
    added = mean_square_error(field, positions, decoded - coefficients, centres, normals) if len(centres) else 0.0
    shutil.rmtree(dump)
    shutil.rmtree(coder.directory)
    decode = {stage: seconds[1] for stage, seconds in times.items()}
    encode = {**encoded["seconds"], "code": sum(seconds[0] for seconds in times.values())}
    encode["total"] = sum(v for k, v in encode.items() if k != "total")
    return {"encode": {**encoded, "bytes": sum(sizes.values()), "seconds": encode,
                       "settings": {**(encoded.get("settings") or {}), "qp": job["rate"], "psnr": "estimated"}},
            "eval": {**measured, "bytes": sum(sizes.values()), "bytes_by_type": sizes, "render": None, "seconds": None,
                     "decode": {"threads": 1, **decode, "total": sum(decode.values())},
                     "input": None, "held_out": with_error(measured.get("held_out"), added)}}
