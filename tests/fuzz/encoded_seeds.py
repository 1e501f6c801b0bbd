# SPDX-License-Identifier: Apache-2.0
"""Seeds that the program makes: files of its encoder, .igc files, a scene in parts."""
import json
import pathlib
import shutil
import subprocess
import tempfile


def igc(program):
    """Files of four cameras of 32 x 32 pixels, as fuzz_igc.cpp expects."""
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "x.igc"
        subprocess.run([program, "synth", "can", "-o", scratch + "/can", "--size", "32x32", "--points", "200"],
                       check=True, capture_output=True)
        made = json.loads((pathlib.Path(scratch) / "can/cameras.json").read_text())
        made = {"cameras": made["cameras"][:4], "splits": {}}
        for i, camera in enumerate(made["cameras"]):
            shutil.copy(pathlib.Path(scratch) / "can" / camera["image"], scratch + f"/can/images/{i}.png")
            camera["image"] = f"images/{i}.png"
        (pathlib.Path(scratch) / "can/cameras.json").write_text(json.dumps(made))
        subprocess.run([program, "igc", scratch + "/can", "-o", str(out), "--split", "all", "--grid-bits", "4"],
                       check=True, capture_output=True)
        return out.read_bytes()


def light_fields(program, splats):
    """Small files of `slf encode`: surfaces of either basis, in slices, in layers, with a title that no page should believe and a view;
    splats, of a PLY."""
    surface = ["can", "--surface", "given", "--effort", "1", "--grid-bits", "4", "--metadata", "title=</title><script>&\"'"]
    kinds = {"harmonics": [*surface, "--degree", "2"], "bspline": [*surface, "--basis", "bspline", "--functions", "8"],
             "slices": [*surface, "--degree", "1", "--slice-points", "16"], "layers": [*surface, "--degree", "1", "--quality-layers", "3"],
             "view": [*surface, "--degree", "0", "--metadata", "view=0 -5 1 0 0 1 40"], "splats": ["s.ply"]}
    made = {}
    with tempfile.TemporaryDirectory() as scratch:
        (pathlib.Path(scratch) / "s.ply").write_bytes(splats)
        subprocess.run([program, "synth", "can", "-o", "can", "--size", "24x24", "--points", "120", "--circles", "2", "--per-circle", "6",
                        "--supersampling", "1"], check=True, capture_output=True, cwd=scratch)
        for name, options in kinds.items():
            subprocess.run([program, "encode", *options, "-o", "x.slf", "--quiet"], check=True, cwd=scratch)
            made[name] = (pathlib.Path(scratch) / "x.slf").read_bytes()
    return made


def scene(program):
    """A plan, and its two parts: of some 400 coloured points on a saddle."""
    rows = [b"%d %d %d %d %d 90\n" % (x, y, x * y // 40, 8 * x, 8 * y) for x in range(32) for y in range(32)
            if (7 * x + 3 * y) % 5 < 2]
    head = ("ply\nformat ascii 1.0\nelement vertex %d\n" % len(rows) + "".join(f"property float {k}\n" for k in "xyz") +
            "".join(f"property uchar {k}\n" for k in ("red", "green", "blue")) + "end_header\n")
    with tempfile.TemporaryDirectory() as scratch:
        at = pathlib.Path(scratch)
        (at / "c.ply").write_bytes(head.encode() + b"".join(rows))
        work = ["--work", scratch + "/work", "--quiet"]
        subprocess.run([program, "plan", scratch + "/c.ply", "-o", scratch + "/plan", "--grid-bits", "5", *work], check=True)
        for part in "12":
            subprocess.run([program, "encode", scratch + "/c.ply", "--plan", scratch + "/plan", "--part", part + "/2",
                            "-o", scratch + "/" + part, *work], check=True)
        first, second = (at / "1").read_bytes(), (at / "2").read_bytes()
        return (at / "plan").read_bytes(), first, second
