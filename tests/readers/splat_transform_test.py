#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""SPZ 2 to 4 and SOG of `slf export` as @playcanvas/splat-transform reads them: the splats of the PLY that they were made of.

    splat_transform_test.py SLF DIRECTORY        DIRECTORY: written by tests/splat_files

Exits with 77 (skipped) where it is not installed: npm ci --prefix tools/rd/splat_transform
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/rd"))
PROGRAM = ROOT / "tools/rd/splat_transform/node_modules/.bin/splat-transform"
FORMATS = {"spz2.spz": ["--spz-version", "2"], "spz3.spz": ["--spz-version", "3"], "spz4.spz": ["--spz-version", "4"], "bundle.sog": []}
TOWARDS_EYE = [(0, 0, 1), (0.6, 0.0, 0.8), (-0.36, 0.48, 0.8), (0.0, -1.0, 0.0)]


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        sys.exit(f"{pathlib.Path(words[0]).name}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


def matched(np, whole, read):
    """For each splat of `whole` the one of `read` that is nearest: no writer has to keep their order."""
    places = [np.argmin(np.square(read.positions - at).sum(1)) for at in whole.positions]
    if len(set(places)) != len(places):
        sys.exit("two splats became one")
    return np.array(places)


def colours(np, splats, order, towards_eye):
    from splat_render import harmonic_values
    values = harmonic_values(np.tile(-np.array(towards_eye, float), (len(order), 1)), splats.harmonics.shape[1])
    return np.clip(0.5 + np.einsum("sh,shc->sc", values, splats.harmonics[order]), 0, 1)


def compare(np, name, whole, read):
    if len(read.positions) != len(whole.positions):
        sys.exit(f"{name}: {len(read.positions)} splats, not {len(whole.positions)}")
    order = matched(np, whole, read)
    extent = np.ptp(whole.positions, axis=0).max()
    place = np.abs(read.positions[order] - whole.positions).max() / extent
    own, other = whole.covariances, read.covariances[order]
    shape = np.sqrt(np.square(other - own).sum((1, 2)) / np.square(own).sum((1, 2))).max()
    faint = np.abs(read.opacities[order] - whole.opacities).max()
    squares = np.mean([np.square(colours(np, read, order, way) - colours(np, whole, np.arange(len(order)), way)).mean() for way in TOWARDS_EYE])
    psnr = -10 * np.log10(squares)
    print(f"{name}: {len(order)} splats; places to {place:.1e} of the extent, shapes to {shape:.2f}, opacities to {faint:.4f}, colours {psnr:.1f} dB")
    # What the formats' own steps lose: 1/4096 of a unit and 16 bits of a logarithm; sizes e^(1/16); 8 bits of a turn, which discs of 1 : 10
    # show; harmonics of 4 to 5 bits.
    if place > 1e-3 or shape > 0.25 or faint > 0.01 or psnr < 30:
        sys.exit(f"{name}: not what was written")


def main():
    if not PROGRAM.exists():
        print("splat_transform_test: skipped, npm ci --prefix tools/rd/splat_transform installs it")
        sys.exit(77)
    import numpy as np
    from splat_render import read_splats
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    whole = folder / "as_read.ply"
    run(PROGRAM, "--overwrite", folder / "ball.ply", whole)
    for name, options in FORMATS.items():
        run(program, "export", folder / "ball.ply", "-o", folder / name, "--quiet", *options)
        run(PROGRAM, "--overwrite", folder / name, folder / f"{name}.ply")
        compare(np, name, read_splats(whole), read_splats(folder / f"{name}.ply"))


if __name__ == "__main__":
    main()
