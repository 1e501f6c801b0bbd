#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stands in for tmc3 in tests: command lines and streams of its form, quantisation without a transform.

The decoder gives the points in reverse order, as the real one gives them in another.
"""
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import numpy as np  # noqa: E402
from one_colour import CHANNELS, write_colours  # noqa: E402
from tmc3 import read_ply, write_ply  # noqa: E402

given = dict(word.removeprefix("--").split("=", 1) for word in sys.argv[1:])
stream = pathlib.Path(given["compressedStreamPath"])


def unit(kind, body):
    return struct.pack(">BI", kind, len(body)) + body


if given["mode"] == "0":
    ply = read_ply(given["uncompressedDataPath"])
    place = np.stack([ply[axis] for axis in "xyz"], 1).astype("<i4")
    out = unit(0, b"s" * 16) + unit(1, b"g") + unit(2, place.tobytes())
    if given.get("attribute") == "color":
        out += unit(3, b"a" * 7) + unit(4, np.stack([ply[name] for name in CHANNELS], 1).astype("u1").tobytes())
    elif given.get("disableAttributeCoding") != "1":
        if given.get("bitdepth") != "8" or given.get("attribute") != "reflectance" or ply["reflectance"].max() > 255:
            sys.exit("one 8-bit attribute is expected")
        step = 2 ** ((int(given["qp"]) - 4) / 6)
        out += unit(3, b"a" * 7) + unit(4, struct.pack("<d", step) + np.round(ply["reflectance"] / step).astype("u1").tobytes())
    stream.write_bytes(out)
else:
    data, at, bodies = stream.read_bytes(), 0, {}
    while at < len(data):
        kind, size = struct.unpack(">BI", data[at:at + 5])
        bodies[kind] = data[at + 5:at + 5 + size]
        at += 5 + size
    place = np.frombuffer(bodies[2], "<i4").reshape(-1, 3)
    plane = None
    if "convertPlyColourspace" in given:
        write_colours(given["reconstructedDataPath"], place[::-1], np.frombuffer(bodies[4], "u1").reshape(-1, 3)[::-1])
        sys.exit()
    if 4 in bodies:
        plane = np.clip(np.round(np.frombuffer(bodies[4], "u1", offset=8) * struct.unpack("<d", bodies[4][:8])[0]), 0, 255)[::-1]
    write_ply(given["reconstructedDataPath"], place[::-1], plane)
