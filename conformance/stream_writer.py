# SPDX-License-Identifier: Apache-2.0
"""Streams written without an encoder: bits of headers, codewords of decisions that are chosen, units. For random_stream.py."""
import pathlib
import random
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "spec"))
import decoder as text  # noqa: E402

SIGNATURE = bytes.fromhex("8B534C460D0A1A0A")


class BitWriter:
    """3.3: the inverse of text.BitReader."""

    def __init__(self):
        self.bits = ""

    def u(self, value, count):
        """3.3: u(n)."""
        self.bits += format(value, f"0{count}b") if count else ""
        return self

    def ue(self, *values):
        """3.3: ue(v)."""
        for value in values:
            self.bits += "0" * ((value + 1).bit_length() - 1) + format(value + 1, "b")
        return self

    def se(self, value):
        """3.3: se(v)."""
        return self.ue(2 * value - 1 if value > 0 else -2 * value)

    def payload(self):
        """3.3: zero bits up to the next byte."""
        padded = self.bits + "0" * (-len(self.bits) % 8)
        return int("1" + padded, 2).to_bytes(len(padded) // 8 + 1, "big")[1:]


class Chooser(text.ArithmeticDecoder):
    """8.3.1 turned round: chooses bits and keeps the codeword that would have given them."""

    random, queue, bias, empty = random.Random(0), None, 0, False     # of the unit at work
    made = []

    def __init__(self, _codeword):
        self.low, self.range, self.bytes = 0, (1 << 32) - 1, 0
        self.codeword = b"" if Chooser.empty else b"?"
        Chooser.made.append(self)

    def decide(self, p):
        """8.3.1: a bit of the queue, or by chance; with a bias it is 1 more often."""
        if Chooser.queue is not None:
            bit = Chooser.queue.pop(0)
        else:
            bit = int(Chooser.random.random() * 65536 < min(p * (1 + Chooser.bias), 60000))
        bound = (self.range >> 16) * p
        if bit:
            self.range = bound
        else:
            self.low, self.range = self.low + bound, self.range - bound
        while self.range < 1 << 24:
            self.low, self.range, self.bytes = self.low << 8, self.range << 8, self.bytes + 1
        return bit

    def finish(self, element):
        """8.3.1: the codeword; that of a matrix is never empty."""
        if self.codeword or element == "cu_matrix":
            self.codeword = self.low.to_bytes(self.bytes + 4, "big")


def unit(unit_type, payload, minor=0):
    """7.1: a unit."""
    length, left = b"", len(payload)
    while left > 127 or not length:
        length += bytes([left & 127 | (128 if left > 127 else 0)])
        left >>= 7
    length += bytes([left]) if left else b""
    version = bytes([1, minor]) if unit_type == text.SEQUENCE else b""      # 7.1.2
    body = bytes([unit_type]) + version + length + payload
    return body + zlib.crc32(body).to_bytes(4, "big")


def stream_of(units):
    """7.1: a stream, with an end unit that counts the others."""
    units = units + [(text.END, BitWriter().ue(len(units)).payload())]
    return SIGNATURE + b"".join(unit(*each) for each in units)
