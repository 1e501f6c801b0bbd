#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random streams of frames, which a decoder has to decode as the text decoder (spec/decoder.py) does.

    random_frames.py --decoder "slf decode {in} --dump {out} {options}" [--seeds FIRST LAST] [--keep DIRECTORY]

As random_streams.py, of light fields that move (7.13, 8.12): motions, lattices and points that move by chance, features, attributes, clouds
that follow the motion or not. Every frame whole, in fewer levels and groups, and the stream with a bit inverted.
Needs numpy. Exit code: 0 all agree, 1 some differ (those streams are kept), 2 usage.
"""
import struct
import sys

from random_stream import RandomStream, text
from random_streams import compare, decoded_by
from stream_writer import SIGNATURE, BitWriter, Chooser, unit


class RandomFrames(RandomStream):
    """Frames of one group; the first is the units of a random stream without a base, with one slice and one layer."""

    of_frames = True

    def __init__(self, seed):
        """Makes all frames; text.Refused where chance broke a rule."""
        super().__init__(seed)
        rng = self.rng
        self.frames = [self.framed(BitWriter().u(0, 1), b"", self.units, 0)]
        light_field = [each for each in text.light_fields(self.frames[0])][0][1]
        self.sequence = light_field.sequence
        for number in range(1, rng.choice([2, 2, 3, 4])):
            light_field = self.predicted_frame(number, text.Reference(light_field))

    def later_elements(self, rng):
        """7.2.1: the features of frames."""
        self.features = rng.choice([(), (1,), (3,), (1, 3), (1, 3)])
        return sum(1 << 31 - i for i in self.features).to_bytes(4, "big") if self.features else b""

    def framed(self, bits, codeword, units, number):
        """7.13: a frame; bits are those behind frame_time but for frame_bytes, which follows their first."""
        units = units + [(text.END, BitWriter().ue(len(units) + 1).payload())]
        behind = b"".join(unit(*each) for each in units if each[0] != text.SEQUENCE)
        header = BitWriter().ue(number)
        header.bits += format(struct.unpack(">Q", struct.pack(">d", float(number)))[0], "064b") + bits.bits[0]
        header.ue(len(behind))
        header.bits += bits.bits[1:]
        frame = unit(text.FRAME, header.payload() + codeword)
        if units[0][0] != text.SEQUENCE:
            return frame + behind
        return SIGNATURE + unit(*units[0], minor=3) + frame + behind

    def motion(self):
        """7.13: the elements of a motion, or that there is none."""
        rng, bits = self.rng, BitWriter().u(1, 1)
        self.moves = 3 in self.features and rng.randrange(3) > 0
        lattice = rng.choice([0, 0, 3, 4, 8])
        if not self.moves and not lattice and rng.randrange(3) == 0:
            return bits.u(0, 1)
        bits.u(1, 1)
        most = rng.choice([0, 300, 300, 40000])
        for _ in range(9):
            bits.se(rng.randrange(-most, most + 1))
        for _ in range(3):
            bits.se(rng.randrange(-60, 61))
        bits.u(int(bool(lattice or self.moves)), 1)
        if lattice or self.moves:
            bits.u(lattice + 6 * bool(self.moves and lattice), 4)
        if lattice:
            bits.ue(*[rng.randrange(3) for _ in range(3)], *[rng.randrange(4) for _ in range(3)])
        return bits

    def predicted_frame(self, number, reference):
        """7.13: the next frame: its points follow those before by chance."""
        rng, side = self.rng, 1 << self.bits
        bits = self.motion()
        by = [rng.randrange(-2, 3) for _ in range(3)]
        points = set()
        for code in self.codes:
            if rng.random() < 0.9:
                at = [x + d + (rng.random() < 0.2) for x, d in zip(text.from_morton(code), by)]
                points.add(tuple(min(max(x, 0), side - 1) for x in at))
        self.codes = sorted(text.morton(*point) for point in points) or self.codes[:1]
        self.cuts, self.first, self.spans = [0, 1], [0], [(0, len(self.codes))]
        header = BitWriter().ue(number)
        header.bits += format(struct.unpack(">Q", struct.pack(">d", float(number)))[0], "064b") + bits.bits[0]
        header.ue(0)
        header.bits += bits.bits[1:]
        keep, text.ArithmeticDecoder = text.ArithmeticDecoder, Chooser
        self.units = []
        try:
            frame = text.Frame(header.payload())
            Chooser.queue, Chooser.empty, Chooser.made = None, False, []
            self.sequence = text.copied(self.sequence, predicted=True)
            self.field = text.LightField(self.sequence, frame, reference)
            slices = BitWriter().ue(0, len(self.codes) - 1).payload()
            self.units.append((text.SLICES, slices))
            frame.codeword = b"?" * bool(frame.lattice_log2 or frame.moves)
            self.field.read_slices(slices)
            codeword = b"".join(chooser.codeword for chooser in Chooser.made if frame.codeword)
            for kind in self.sequence.unit_order(False):
                self.unit_of(0, kind)
        finally:
            text.ArithmeticDecoder = keep
        self.frames.append(self.framed(bits, codeword, self.units, number))
        return [each for each in text.light_fields(b"".join(self.frames))][-1][1]

    def requests(self):
        """Streams and what is asked of them: levels, groups; the last one damaged."""
        rng, data = self.rng, b"".join(self.frames)
        groups = rng.randrange(self.groups) + 1 if self.groups else 0
        yield data, 0, 0
        yield data, rng.randrange(1, self.bits + 1), 0
        yield data, rng.choice([0, rng.randrange(1, self.bits + 1)]), groups
        place = rng.randrange(len(self.frames))
        damaged = bytearray(self.frames[place])
        damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
        yield b"".join([*self.frames[:place], damaged, *self.frames[place + 1:]]), 0, 0


def decoded_by_text(data, levels, groups):
    """The arrays of every frame by name, up to one that the text decoder refuses, which is None."""
    found = []
    try:
        for _, light_field in text.light_fields(data):
            sequence = light_field.sequence
            wanted = text.Wanted(sequence, levels, groups, 0)
            positions, components, normals = text.given_out(sequence, light_field, wanted, None)
            arrays = {"positions": positions, "components": components}
            found.append({**arrays, "octahedral": normals} if sequence.normal_bits else arrays)
    except text.Refused:
        found.append(None)
    return found


def tries_of(frames, decoder, folder):
    """As random_streams.py has it, of every frame."""
    for data, levels, groups in frames.requests():
        for frame, ours in enumerate(decoded_by_text(data, levels, groups)):
            command = decoder.replace("{options}", f"--frame {frame} " * bool(frame) + "{options}")
            asked = f"frame {frame}, levels, groups {levels, groups}"
            yield data, asked, ours, *decoded_by(command, folder, (data, levels, groups, 0, []))


if __name__ == "__main__":
    sys.exit(compare("frames", __doc__, RandomFrames, tries_of))
