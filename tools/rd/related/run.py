#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The codecs that the paper names, on the same observations as ours: curves, BD-rates, plots (docs/related-codecs.md).

    run.py --slf build/bin/slf --out DIR [--data DIR] [CAPTURE=GRID_BITS ...]

Captures are names or sources of tools/rd/captures.json, by default the three of the document. DIR has CAPTURE.json (a row for
each codec and setting: bytes, PSNR at observations of fitted and of held-out cameras), CAPTURE.png and table.md. Rows that are
there are not made again. `--only TEXT,...` makes the codecs whose names hold one of these, `--draw` none."""
import argparse
import json
import os
import pathlib
import sys
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]
import captures  # noqa: E402
import curves  # noqa: E402
import ours  # noqa: E402
import refit  # noqa: E402
from chen import Chen  # noqa: E402
from miller import Miller  # noqa: E402
from multiview import Multiview  # noqa: E402
from observations import Scene  # noqa: E402
from planes import Packer  # noqa: E402
from views import RahtKlt, Volino  # noqa: E402
from wood import Principal, Quantised  # noqa: E402

CAPTURES = {"blender_can": 7, "die": 6, "middlebury_dino": 7}
CELL = 8   # voxels: some 60 points of these grids
# Name: how it is made, and settings (step first). Of settings that others beat in bytes and dB a curve leaves out those.
RELATED = {
    "Miller, each point alone": (lambda s, p: Miller(s, p, 8, False), [(r,) for r in (512, 256, 128, 64)]),
    "Miller, planes by RAHT": (lambda s, p: Miller(s, p, 8, True), [(r,) for r in (512, 256, 128, 64, 32)]),
    "Wood, function quantisation": (Quantised, [(96, 4), (64, 8), (48, 24), (32, 64), (16, 192)]),
    "Wood, principal functions": (Principal, [(128, 1), (96, 2), (64, 3), (48, 6), (32, 9), (16, 12)]),
    "Chen, PCA": (lambda s, p: Chen(s, p, "pca", CELL), [(q, k) for q in (256, 128, 64, 32, 16) for k in (1, 3)]),
    "Chen, NMF": (lambda s, p: Chen(s, p, "nmf", CELL), [(q, k) for q in (128, 64, 32) for k in (1, 3)]),
    "Volino, most frontal": (lambda s, p: Volino(s, p, "frontal"), [(64, 1), (64, 3), (32, 3), (32, 8), (16, 8)]),
    "Volino, spread": (lambda s, p: Volino(s, p, "spread"), [(128, 5), (128, 8), (64, 8), (32, 8)]),
    "RAHT-KLT": (RahtKlt, [(r,) for r in (384, 192, 96, 48)]),
    "multi-view, predicted": (Multiview, [(r, 16) for r in (512, 256, 128, 64)] + [(512, 32), (256, 32)]),
}


class Rows:
    """Rows of one capture, kept in a file."""

    def __init__(self, path):
        self.path = path
        self.all = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []

    def missing(self, codec, settings):
        return [s for s in settings if not any(r["codec"] == codec and r["setting"] == list(s) for r in self.all)]

    def add(self, row):
        self.all.append(row)
        self.path.write_text(json.dumps(self.all, indent=1) + "\n", encoding="utf-8")
        print(f"{self.path.stem}: {row['codec']} {row['setting']}: {row['bytes']:,.0f} bytes, held out {row['held_out']:.2f} dB, "
              f"fitted {row['fitted']:.2f} dB, {row['seconds']:.0f} s", flush=True)


def on_the_grid(slf, capture, bits, folder):
    """Positions and grid that `slf encode` makes of a capture's points, whatever is coded on them."""
    cloud = ["--points", capture.points] if capture.points else []
    ours.spoken([slf, "encode", capture.directory, "-o", folder / "grid.slf", "--preset", "paper", "--functions", "1", "--surface", "given",
                 "--densify", "off", "-q", "200", "--grid-bits", bits, *cloud, "--quiet", "--json"])
    ours.spoken([slf, "decode", folder / "grid.slf", "--dump", folder / "grid", "--quiet", "--json"])
    grid = json.loads((folder / "grid" / "light_field.json").read_text(encoding="utf-8"))["grid"]
    return np.load(folder / "grid" / "positions.npy"), grid["origin"], grid["step"]


def named(codec, wanted):
    return any(text in codec for text in wanted.split(","))


def measure(rows, name, wanted, slf, capture, bits, folder):
    """All that is missing, of codecs whose name holds one of the texts `wanted`."""
    for codec, (_, _, rates) in ours.CODECS.items():
        for (rate,) in rows.missing(codec, [(r,) for r in rates] if named(codec, wanted) else []):
            before = time.monotonic()
            rows.add({"capture": name, **ours.encoded(slf, capture, codec, rate, bits, folder), "setting": [rate],
                      "seconds": round(time.monotonic() - before, 1)})
    related = {codec: (make, left) for codec, (make, settings) in RELATED.items()
               if named(codec, wanted) and (left := rows.missing(codec, settings))}
    if not related:
        return
    positions, origin, step = on_the_grid(slf, capture, bits, folder)
    scene, packer = Scene(capture.directory, positions, origin, step, capture.points), Packer(slf, positions)
    for codec, (make, settings) in related.items():
        made = None  # frees the one before
        made = make(scene, packer)
        for setting in settings:
            before = time.monotonic()
            size, colours = made.coded(*setting)
            row = {"capture": name, "codec": codec, "setting": list(setting), "bytes": int(np.ceil(size + packer.geometry)),
                   "points": len(positions), "held_out": scene.held_out.psnr(colours(scene.held_out)),
                   "fitted": scene.fitted.psnr(colours(scene.fitted)), "seconds": round(time.monotonic() - before, 1)}
            if codec == "multi-view, predicted":
                row["held_out_blended"] = row["held_out"]
                row["held_out"] = refit.held_out(slf, capture, scene, made.decoded, bits, folder)
            rows.add(row)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE=GRID_BITS", default=[f"{c}={b}" for c, b in CAPTURES.items()])
    parser.add_argument("--slf", required=True)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--data", default=os.environ.get("SLF_DATA"))
    parser.add_argument("--only", default="")
    parser.add_argument("--draw", action="store_true", help="plots and table of the rows that are there")
    given = parser.parse_args()
    slf, rows = str(pathlib.Path(given.slf).resolve()), []
    for word in given.captures:
        source, _, bits = word.rpartition("=")
        if not source or not bits.isdigit() or not 1 <= int(bits) <= 21:
            parser.error(f"{word}: CAPTURE=GRID_BITS is expected, bits 1 to 21")
        name = pathlib.Path(source.partition("?")[0]).name.rpartition(":")[2]
        folder = given.out / name
        folder.mkdir(parents=True, exist_ok=True)
        mine = Rows(given.out / f"{name}.json")
        if not given.draw:
            described = captures.resolve(*captures.parse_source(captures.aliases().get(source, source), captures.scenes_of(slf)), slf, "",
                                         given.out, given.data)
            capture = argparse.Namespace(**described)
            measure(mine, name, given.only, slf, capture, int(bits), folder)
        rows += mine.all
    curves.write(given.out, rows)


if __name__ == "__main__":
    main()
