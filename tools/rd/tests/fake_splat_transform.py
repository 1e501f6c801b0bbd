#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stands in for splat-transform in tests: its command line; a "coded" file is the PLY with colours rounded, deflated.

A file that is named broken fails, as one does that the real program cannot read.
"""
import pathlib
import sys
import zlib

import numpy as np

words = [word for word in sys.argv[1:] if word not in ("--overwrite", "--gpu", "cpu")]
if len(words) != 2 or "--overwrite" not in sys.argv:
    sys.exit("input and output are expected")
source, result = map(pathlib.Path, words)
if "broken" in source.name:
    sys.exit(f"Error: {source.name} is broken")
data = source.read_bytes()
if result.suffix == ".ply":
    result.write_bytes(zlib.decompress(data))
else:
    head, body = data.split(b"end_header\n", 1)
    rows = np.frombuffer(body, "<f4").reshape(-1, len(head.split(b"property ")) - 1).copy()
    rows[:, 3:] = np.round(rows[:, 3:] * 16) / 16
    result.write_bytes(zlib.compress(head + b"end_header\n" + rows.tobytes()))
