#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stands in for slf in tests: made-up numbers in the form of the real reports.

--lambda 99 makes encode fail; FAKE_SLF_CALLS names a file that gets a line per call.
"""
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import zlib

PROGRAM = pathlib.Path(__file__).resolve().parents[3] / "build" / "bin" / "slf"
PREFERS = {"order": 2, "functions": 128, "lambda": 0.8, "beta": 1.3, "delta": 10}
BYTES = {"raht": 100_000, "texture": 80_000, "hevc": 150_000, "hevc-intra": 400_000, "av1": 120_000}


def png(path, size=24):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + bytes((x * 9 % 256, y * 9 % 256, 90)[c] for x in range(size) for c in range(3)) for y in range(size))
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
                                   + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def synth(options, positional):
    out = pathlib.Path(options["o"])
    (out / "images").mkdir(parents=True)
    cameras = [{"image": f"images/{n:04}.png", "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "t": [n % 3 - 1, n % 5 - 2, 5]} for n in range(48)]
    splits = {"dense": [c["image"] for c in cameras[:4]], "sparse": [cameras[0]["image"]],
              "intermediate": [c["image"] for c in cameras[:2]], "evaluation": [c["image"] for c in cameras[4:]]}
    for camera in cameras:
        png(out / camera["image"])
    (out / "cameras.json").write_text(json.dumps({"cameras": cameras, "splits": splits}))
    (out / "points.ply").write_text(f"ply\nformat ascii 1.0\ncomment {positional[0]}\nelement vertex 1\nproperty float x\n"
                                    "property float y\nproperty float z\nend_header\n0 0 0\n")


def encode(options, positional):
    if options.get("lambda") == "99":
        sys.exit("slf: lambda 99 is what this one fails at")
    kind = options.get("codec") or ("texture" if options.get("coefficients") == "texture" else "raht")
    step = float(options["quality"]) if "quality" in options else 2 ** (float(options.get("qp") or options["texture-qp"]) / 6 - 1)
    bytes_ = int(BYTES[kind] * (8 / step) ** 0.9 * int(options.get("functions", 128)) ** 0.3)
    loss = sum(0.3 * abs(math.log2((float(options.get(k, v)) + 0.1) / (v + 0.1))) for k, v in PREFERS.items())
    loss += {"dense": 0, "intermediate": 0.7, "sparse": 2}.get(options["split"], 1) * (2 if "die" in positional[0] else 1)
    pathlib.Path(options["o"]).write_text(json.dumps({"kind": kind, "fit": options.get("fit"), "bytes": bytes_, "psnr": 30 - loss - step / 16}))
    print(json.dumps({"bytes": bytes_, "points": 1000, "cameras": 4, "seconds": {"fit": 0.5, "total": 1.0},
                      "peak_memory_mib": 50.0, "settings": {k: v for k, v in options.items() if k != "o"}}))


def quality(psnr, options):
    image = None if "no-images" in options else {"psnr": psnr - 3, "ssim": 0.9, "ms_ssim": 0.95, "coverage": 0.98, "psnr_each": [psnr],
                                                     "all": {"psnr": psnr}, "regions": {"rim": {"error_share": 0.2}}}
    points = [{"delta": float(d), "psnr": psnr + float(d) / 30, "luma_psnr": psnr + 1, "channel_psnr": [psnr] * 3,
               "observations": 5000} for d in options["delta-eval"].split(",")]
    return {"cameras": 4, "points": points, "image": image}


def evaluate(options, positional):
    coded = json.loads(pathlib.Path(positional[0]).read_text())
    igc = coded["kind"] in ("hevc", "hevc-intra", "av1")
    decode = {"threads": 1, "geometry": 0.1, "images": 0.5, "observe": 0.5, "fit": 3.0, "total": 4.1} if igc else \
        {"threads": 1, "geometry": 0.1, "coefficients": 0.2, "total": 0.3}
    print(json.dumps({"bytes": coded["bytes"], "points": 1000, "bits_per_point": coded["bytes"] / 125, "settings": {},
                      "bytes_by_type": {"geometry": 800, "coefficients": coded["bytes"] - 800}, "decode": decode,
                      "render": None if "no-images" in options else {"seconds_per_image": 0.01, "width": 24, "height": 24},
                      "input": quality(coded["psnr"] + 3, options), "held_out": quality(coded["psnr"], options), "seconds": 1.0}))


def render(options, positional):
    png(options["o"], 48 if "orbit" in options else 24)


def decode(options, positional):
    import numpy as np
    out = pathlib.Path(options["dump"])
    out.mkdir(parents=True)
    np.save(out / "components.npy", np.arange(-24, 24, dtype=np.int32).reshape(4, 4, 3))
    np.save(out / "positions.npy", np.arange(12, dtype=np.int32).reshape(4, 3))
    harmonics = json.loads(pathlib.Path(positional[0]).read_text())["fit"] == "hierarchical"
    basis = {"id": "harmonics", "degree": 1} if harmonics else {"order": 2, "scales_theta": 1, "scales_gamma": 1}
    (out / "light_field.json").write_text(json.dumps(
        {"shift": [1, 1, 1, 1], "basis": basis, "gamma_range": [-1, 1],
         "grid": {"origin": [0, 0, 0], "step": 0.1}, "colour": {"to_rgb": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}}))


FLAGS = {"json", "quiet", "no-images", "sheet", "penalise-dc", "free-dc", "linear", "list"}


def main(words):
    if os.environ.get("FAKE_SLF_CALLS"):
        with open(os.environ["FAKE_SLF_CALLS"], "a") as file:
            file.write(" ".join(words) + "\n")
    if words == ["--version"]:
        return print("slf fake")
    if words == ["settings", "--json"]:  # the program's own
        return subprocess.run([os.environ.get("SLF_PROGRAM", PROGRAM), *words], check=True)
    if words[:2] == ["synth", "--list"]:
        return print("can  a can\ndie  a die")
    options, positional, rest = {}, [], words[1:]
    while rest:
        word = rest.pop(0)
        if not word.startswith("-"):
            positional.append(word)
        else:
            options[word.lstrip("-")] = True if word.lstrip("-") in FLAGS else rest.pop(0)
    verbs = {"synth": synth, "encode": encode, "igc": encode, "eval": evaluate, "render": render, "decode": decode}
    verbs[words[0]](options, positional)


if __name__ == "__main__":
    main(sys.argv[1:])
