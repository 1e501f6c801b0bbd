#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trained splats drawn by the library against the reference rasterisation in numpy (tools/rd/splat_render.py).

    gaussian_reference_test.py ROOT PROGRAM SPLATS...

PROGRAM is gaussian_pictures. Where there are no files of splats, or no numpy and scipy, the test is skipped (77).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

LEAST = 45.0  # dB


def worst_of(root, program, files):
    """Least PSNR; prints a line for each picture."""
    import numpy as np
    sys.path.insert(0, str(root / "tools/rd"))
    from splat_render import read_splats, render
    worst = np.inf
    for file in files:
        with tempfile.TemporaryDirectory() as scratch:
            subprocess.run([program, file, scratch + "/"], check=True)
            splats = read_splats(file)
            for view in sorted(pathlib.Path(scratch).glob("*.json")):
                head, pixels = view.with_suffix(".ppm").read_bytes().split(b"\n", 1)
                width, height = (int(word) for word in head.split()[1:3])
                ours = np.frombuffer(pixels, np.uint8).reshape(height, width, 3).astype(float)
                colours, coverage = render(splats, json.loads(view.read_text()))
                psnr = 10 * np.log10(255 ** 2 / np.mean((np.clip(255 * colours, 0, 255) - ours) ** 2))
                print(f"{file.name} {view.stem}: {psnr:.2f} dB, {coverage.mean():.3f} covered")
                worst = min(worst, psnr if coverage.mean() > 0.02 else 0)
    return worst


def main():
    """The exit status says it."""
    files = [pathlib.Path(name) for name in sys.argv[3:] if pathlib.Path(name).exists()]
    try:
        import scipy  # noqa: F401  (what splat_render needs)
    except ImportError:
        files = []
    if not files:
        print("no files of splats, or no scipy: skipped")
        sys.exit(77)
    sys.exit(0 if worst_of(pathlib.Path(sys.argv[1]), sys.argv[2], files) >= LEAST else 1)


if __name__ == "__main__":
    main()
