# SPDX-License-Identifier: Apache-2.0
"""Files of a capture, and what its cameras mean; without Blender."""
import os
import struct
import sys
import traceback
import zlib

import numpy as np

RADIUS = 5.0  # of the sphere that cameras stand on; the scene lies within 1 of the origin


def run(main):
    """Blender alone would go on after an error, and exit with 0."""
    try:
        main()
    except SystemExit:
        raise
    except BaseException:
        traceback.print_exc()
        sys.exit(1)


def centre_of(row):
    return -np.array(row["R"]).T @ np.array(row["t"])


def write_whole(path, data):
    """Complete or not at all."""
    partial = path.with_name(path.name + ".partial")
    partial.write_bytes(data)
    os.replace(partial, path)


def png(pixels):
    """Bytes of an 8-bit RGB PNG. pixels: [height, width, 3]."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b"")


def write_ply(path, columns):
    """Binary vertices. columns: [(names, type of PLY, values [n, names])]."""
    kinds = {"float": "<f4", "uchar": "u1"}
    fields = [(name, kinds[kind]) for names, kind, _ in columns for name in names]
    rows = np.zeros(len(columns[0][2]), fields)
    for names, _, values in columns:
        for k, name in enumerate(names):
            rows[name] = values[:, k]
    header = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(rows)}\n" + \
        "".join(f"property {kind} {name}\n" for names, kind, _ in columns for name in names) + "end_header\n"
    write_whole(path, header.encode() + rows.tobytes())
