#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A file above 4 GiB is listed and decoded as what it holds; without leave to take as much memory it is refused.

    large_file_test.py SLF

A stream of the suite with 17 units of 2^28 - 1 bytes that every decoder skips (7.1.1). Its zeros take no place on the disk,
but they take 4.6 GB of memory: exits with 77 (skipped) where there are not as many.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "spec"), str(ROOT / "conformance")]
import decoder as text  # noqa: E402
from stream_writer import SIGNATURE, BitWriter, unit  # noqa: E402

LARGE, SIZE, TYPE = 17, (1 << 28) - 1, 100
LIMIT = 5  # exit code


def write_zeros(out):
    """A unit of SIZE zeros, as a hole of the file."""
    length, left = b"", SIZE
    while left > 127:
        length, left = length + bytes([left & 127 | 128]), left >> 7
    head = bytes([TYPE]) + length + bytes([left])
    crc, block = zlib.crc32(head), bytes(1 << 20)
    for at in range(0, SIZE, len(block)):
        crc = zlib.crc32(block[:SIZE - at], crc)
    out.write(head)
    out.seek(SIZE, os.SEEK_CUR)
    out.write(crc.to_bytes(4, "big"))


def enlarge(small, file):
    units = text.read_units(small.read_bytes())
    with open(file, "wb") as out:
        out.write(SIGNATURE)
        for kind, payload, _ in units[:-1]:
            if kind == text.SEQUENCE:
                payload = bytes([payload[0] & 0xF0]) + payload[1:]  # level 0, which promises no size of units
            out.write(unit(kind, payload))
        for _ in range(LARGE):
            write_zeros(out)
        out.write(unit(text.END, BitWriter().ue(len(units) - 1 + LARGE).payload()))


def run(*words, code=0):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != code:
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}, not {code}\n{done.stderr}")
    return done.stdout


def main():
    program = sys.argv[1]
    if os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") < 6 << 30:
        print("large_file_test: skipped, there are no 6 GiB of memory")
        sys.exit(77)
    small = ROOT / "conformance/streams/no-index-no-digest/stream.slf"
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        large = scratch / "large.slf"
        enlarge(small, large)
        size = large.stat().st_size
        said = run(program, "info", large).split("\n")[0]
        if size <= 1 << 32 or f"{size:,} bytes" not in said:
            sys.exit(f"{size:,} bytes; slf info says: {said}")
        run(program, "decode", large, "-o", scratch / "x.ply", "--quiet", code=LIMIT)
        run(program, "decode", large, "--dump", scratch / "large", "--max-memory", "6G", "--quiet")
        run(program, "decode", small, "--dump", scratch / "small", "--quiet")
        for file in (scratch / "small").iterdir():
            if file.suffix == ".npy" and file.read_bytes() != (scratch / "large" / file.name).read_bytes():
                sys.exit(f"{file.name} differs")


if __name__ == "__main__":
    main()
