# SPDX-License-Identifier: Apache-2.0
"""Eleven ordinary files: what `slf encode` and `slf pack` write of small scenes, whose settings differ in what the format has."""
import subprocess

import numpy as np

SCENES = {
    "can": "can --size 64x64 --points 420 --circles 3 --per-circle 6 --supersampling 1",
    "vase": "vase --size 64x64 --points 520 --circles 3 --per-circle 6 --supersampling 1",
    "walk": "walk --frames 2 --size 48x48 --points 260 --circles 2 --per-circle 6 --supersampling 1",
}
WHOLE = (0, 0, 0, None)
# Name, scene, options, what is asked for: levels, groups, layers, region.
FILES = [
    ("default", "can", "--functions 16", [WHOLE]),
    ("normals", "vase", "--functions 8 --normal-bits 8 -q 6", [WHOLE]),
    ("shared", "can", "--functions 8 --base-levels 2 --slice-points 130", [WHOLE, (4, 0, 0, None)]),
    ("apart", "can", "--functions 8 --base-levels 2 --slice-points 130 --slice-start apart", [WHOLE, (3, 0, 0, None)]),
    ("layers", "can", "--functions 8 --quality-layers 3 --klt joint", [WHOLE, (0, 0, 2, None), (0, 0, 1, None)]),
    ("independent", "can", "--functions 4 --coefficients independent --predict off -q 8", [WHOLE]),
    ("from-base", "vase", "--functions 4 --slice-start base --base-levels 3 --slice-points 90 -q 2", [WHOLE, (4, 1, 0, None)]),
    ("texture", "can", "--functions 4 --coefficients texture", [WHOLE, (5, 0, 0, None)]),
    ("frames", "walk", "--functions 2", [WHOLE]),
]


def cloud(bits):
    """Points of a bent sheet with a few that float above it: [P, 3], in no order."""
    generator, most = np.random.default_rng(7), (1 << bits) - 1
    u, v = generator.random((2, 900)) * 2 - 1
    sheet = np.stack([u, v, 0.5 * np.sin(3 * u) * np.cos(2 * v)], axis=1)
    floating = generator.random((40, 3)) * 2 - 1
    return np.unique(np.rint((np.concatenate([sheet, floating]) + 1) / 2 * most).astype(np.int32), axis=0)


def ordinary_files(slf, folder):
    """Writes them into a folder: (name, bytes, requests) of each."""
    folder.mkdir(exist_ok=True)

    def call(*words):
        """Runs the program."""
        subprocess.run([slf, *words], check=True, capture_output=True)

    for name, options in SCENES.items():
        call("synth", *options.split(), "-o", str(folder / name))
    made = []
    for name, scene, options, requests in FILES:
        call("encode", str(folder / scene), "-o", str(folder / f"{name}.slf"), "-j", "1", "--densify", "off", "--surface", "given", "--quiet", *options.split())
        made.append([name, (folder / f"{name}.slf").read_bytes(), requests])
    np.save(folder / "positions.npy", cloud(7))
    call("pack", str(folder / "positions.npy"), "-o", str(folder / "cloud.slf"), "--quiet")
    made.append(["cloud", (folder / "cloud.slf").read_bytes(), [WHOLE, (0, 0, 0, [13, 27, 5, 90, 101, 77]), (5, 0, 0, [13, 27, 5, 90, 101, 77])]])
    cut = next(data for name, data, _ in made if name == "from-base")
    made.append(["prefix", cut[:len(cut) * 3 // 5], [WHOLE, (3, 0, 0, None), (5, 0, 0, None)]])
    return [tuple(each) for each in made]
