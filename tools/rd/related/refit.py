# SPDX-License-Identifier: Apache-2.0
"""Held-out quality of codecs that keep photographs: our fit of what they decode, as a decoder of IGC does it."""
import shutil

import matplotlib.image
import numpy as np

from ours import POINTS, spoken

FINE = "1"   # -q of a file that stands for the fit itself


def held_out(slf, capture, scene, pictures, bits, folder):
    """Point PSNR at held-out cameras. pictures: number of a fitted camera to [height, width, 3]."""
    copy = folder / "decoded"
    shutil.rmtree(copy, ignore_errors=True)
    for number, camera in enumerate(scene.cameras):
        path = copy / camera.name
        path.parent.mkdir(parents=True, exist_ok=True)
        if number in pictures:
            matplotlib.image.imsave(path, np.clip(np.rint(pictures[number]), 0, 255).astype(np.uint8))
        else:
            shutil.copyfile(camera.path, path)
    shutil.copyfile(f"{capture.directory}/cameras.json", copy / "cameras.json")
    cloud = capture.points or f"{capture.directory}/points.ply"
    spoken([slf, "encode", copy, "--points", cloud, "-o", folder / "decoded.slf", "--preset", "default", *POINTS, "-q", FINE, "--grid-bits", bits,
            "--quiet", "--json"])
    shutil.rmtree(copy)
    quality = spoken([slf, "eval", folder / "decoded.slf", capture.directory, "--points", cloud, "--no-images", "--quiet", "--json"])
    return quality["held_out"]["points"][0]["psnr"]
