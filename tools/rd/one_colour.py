# SPDX-License-Identifier: Apache-2.0
"""One colour a point by the G-PCC reference software (TMC13), its common test conditions of lossless geometry and lossy colours."""
import pathlib
import subprocess
import tempfile
import time

import numpy as np

from tmc3 import ATTRIBUTE_UNITS, GEOMETRY, rank, read_ply, units

QPS = (22, 28, 34, 40, 46)
COLOURS = ("--transformType=0 --rahtPredictionSearchRange=50000 --qpChromaOffset=-1 --bitdepth=8 --attrOffset=0 --attrScale=1 "
           "--convertPlyColourspace=1").split()
CHANNELS = ("red", "green", "blue")


def write_colours(path, positions, colours):
    rows = np.zeros(len(positions), [(axis, "<f4") for axis in "xyz"] + [(name, "u1") for name in CHANNELS])
    for i, axis in enumerate("xyz"):
        rows[axis], rows[CHANNELS[i]] = positions[:, i], colours[:, i]
    header = "".join(f"property float {axis}\n" for axis in "xyz") + "".join(f"property uchar {name}\n" for name in CHANNELS)
    pathlib.Path(path).write_bytes(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{header}end_header\n".encode() + rows.tobytes())


def coded(program, positions, colours, qp):
    """(bytes of geometry, bytes of colours, decoded colours [P, 3] in our order, seconds of encoding)."""
    with tempfile.TemporaryDirectory() as scratch:
        ply, stream, back = (f"{scratch}/{name}" for name in ("in.ply", "x.bin", "out.ply"))
        write_colours(ply, positions, colours)
        before = time.monotonic()
        subprocess.run([program, *GEOMETRY, *COLOURS, f"--qp={qp}", "--attribute=color", f"--uncompressedDataPath={ply}",
                        f"--compressedStreamPath={stream}"], check=True, capture_output=True)
        seconds = time.monotonic() - before
        subprocess.run([program, "--mode=1", "--convertPlyColourspace=1", f"--compressedStreamPath={stream}", f"--reconstructedDataPath={back}"],
                       check=True, capture_output=True)
        sizes, decoded = units(pathlib.Path(stream).read_bytes()), read_ply(back)
    place = np.round(np.stack([decoded[axis] for axis in "xyz"], 1)).astype(np.int64)
    order, mine = rank(place), rank(positions)
    if len(place) != len(positions) or (place[order] != positions[mine]).any():
        raise ValueError("tmc3 did not give the points back")
    values = np.empty((len(positions), 3))
    values[mine] = np.stack([decoded[name] for name in CHANNELS], 1)[order]
    of_colours = sum(size for kind, size in sizes if kind in ATTRIBUTE_UNITS)
    return sum(size for _, size in sizes) - of_colours, of_colours, values, seconds
