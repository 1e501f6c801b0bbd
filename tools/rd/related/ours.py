# SPDX-License-Identifier: Apache-2.0
"""The codecs of the tree on the same points, by the program: encoded, then judged by `slf eval`, whose measure is that of this folder."""
import json
import subprocess

POINTS = ["--surface", "given", "--densify", "off", "--fit-to", "points"]   # of `slf encode`: fitted to the observations
CODECS = {"slf": (["--preset", "default", *POINTS], "-q", (4, 8, 24, 64, 160, 400)),
          "the paper": (["--preset", "paper"], "-q", (8, 24, 64, 160)),
          "IGC, HEVC": (["--preset", "default", *POINTS, "--chroma", "444"], "--qp", (20, 28, 36, 44, 51))}


def spoken(words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(str(w) for w in words[:2])}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def encoded(slf, capture, codec, rate, grid_bits, out):
    """Row of one encode."""
    options, name, _ = CODECS[codec]
    coded = out / f"{codec.split(',')[0].replace(' ', '_')}_{rate:g}.{'igc' if 'IGC' in codec else 'slf'}"
    cloud = ["--points", capture.points] if capture.points else []
    spoken([slf, "igc" if "IGC" in codec else "encode", capture.directory, "-o", coded, *options, name, f"{rate:g}",
            "--grid-bits", grid_bits, *cloud, "--quiet", "--json"])
    quality = spoken([slf, "eval", coded, capture.directory, *cloud, "--no-images", "--quiet", "--json"])
    return {"codec": codec, "rate": rate, "bytes": coded.stat().st_size, "points": quality["points"],
            "held_out": quality["held_out"]["points"][0]["psnr"], "fitted": quality["input"]["points"][0]["psnr"]}
