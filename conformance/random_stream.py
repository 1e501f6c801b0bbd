# SPDX-License-Identifier: Apache-2.0
"""A random stream, made without an encoder: the text decoder (spec/decoder.py) runs with something in place of its
arithmetic decoder that chooses decisions, at random by their probabilities or by a cloud of points, and writes
down the codeword they make. So a stream may have any order of units, level ranges, groups, base and runs of
cells that the syntax allows, whether an encoder would write them or not. For random_streams.py.
"""
import math
import random

import numpy as np
from stream_writer import SIGNATURE, BitWriter, Chooser, stream_of, text, unit


def random_cloud(rng, bits):
    """Morton codes of a sphere, of noise or of a bent patch."""
    side, points = 1 << bits, set()
    kind, count = rng.choice(["sphere", "noise", "patch"]), rng.choice([5, 30, 60, 120, 400])
    corner, width = [rng.randrange(max(side - 24, 0) + 1) for _ in range(3)], min(side, 24)
    for _ in range(count):
        if kind == "noise":
            points.add(tuple(rng.randrange(side) for _ in range(3)))
        elif kind == "sphere":
            v = np.array([rng.gauss(0, 1) for _ in range(3)]) + 1e-9
            points.add(tuple(int(c) for c in np.clip((v / np.linalg.norm(v) * 0.45 + 0.5) * side, 0, side - 1)))
        else:
            x, y = rng.randrange(width), rng.randrange(width)
            points.add((corner[0] + x, corner[1] + y, corner[2] + x * y // width % width))
    return sorted(text.morton(*point) for point in points)


def range_ends(rng, bits, base, most):
    """7.2: ends of level ranges, the base's among them."""
    ends = {base} | {rng.randrange(1, bits) for _ in range(rng.randrange(most))}
    return sorted(end for end in ends if end)


class RandomStream:
    """A stream; its units without the index and the end unit are left in `units`."""

    of_frames = False                       # 7.13: no base, one layer, vectors

    def __init__(self, seed):
        """Makes all units; text.Refused where chance broke a rule, such as a magnitude that is too great."""
        self.rng = rng = Chooser.random = random.Random(seed)
        Chooser.bias = rng.choice([0, 0, 0.15, 0.4])
        self.bits = rng.choice([2, 3, 4, 5, 6, 7, 8, 12, 21])
        self.base = rng.choice([0] + [rng.randrange(1, self.bits) for _ in range(3)])
        self.base = 0 if self.of_frames else self.base
        self.codes = random_cloud(rng, self.bits)
        self.runs()
        later = random.Random(-seed - 1)
        self.later = self.later_elements(later)
        self.sequence_unit()
        self.units = [(text.SEQUENCE, self.sequence_payload(""))]
        self.sequence = text.Sequence(self.units[0][1])
        keep, text.ArithmeticDecoder = text.ArithmeticDecoder, Chooser
        try:
            self.coded_units()
        finally:
            text.ArithmeticDecoder = keep
        for _ in range(later.choice([0, 0, 1, 4])):         # 7.1.1: units to skip
            skipped = later.choice([64, 127, 192, 224, 255]), later.randbytes(later.randrange(200))
            self.units.insert(later.randrange(1, len(self.units) + 1), skipped)
        text.decode(stream_of(self.units), 0, 0, 0, [])        # refused where a coefficient is too great

    def later_elements(self, rng):
        """7.2.1: what stands behind the header."""
        return rng.choice([b"", b"", bytes(4), bytes(4) + rng.randbytes(rng.randrange(300))])

    def runs(self):
        """8.2: base cells, and runs of them."""
        cell = [code >> 3 * (self.bits - self.base) for code in self.codes] if self.base else [0] * len(self.codes)
        self.first = [i for i in range(len(cell)) if i == 0 or cell[i] != cell[i - 1]]
        count = min(self.rng.choice([1, 2, 3, 5]) if self.base else 1, len(self.first))
        self.cuts = [0] + sorted(self.rng.sample(range(1, len(self.first)), count - 1)) + [len(self.first)]
        bounds = self.first + [len(self.codes)]
        self.spans = [(bounds[a], bounds[b]) for a, b in zip(self.cuts, self.cuts[1:])]
        self.start = self.rng.randrange(3) if len(self.spans) > 1 else 1       # 7.3

    def sequence_unit(self):
        """7.2: the header in three pieces, between which sps_cut_flag and sps_cut_layers stand."""
        rng = self.rng
        self.normal_bits = rng.choice([0, 0, 4, 7])
        head = BitWriter().u(0, 8).u(self.bits - 1, 5).u(1, 1).u(4, 3).u(0, 4).u(self.normal_bits, 4)
        head.u(self.base, 5)
        self.geometry = range_ends(rng, self.bits, self.base, 3)
        tail = BitWriter().ue(len(self.geometry))
        for end in self.geometry:
            tail.u(end, 5)
        functions = rng.choice([0, 1, 3, 3, 6])
        self.groups = rng.randrange(1, min(functions, 3) + 1) if functions else 0
        self.prediction = rng.randrange(2)
        self.transform = rng.randrange(3) == 0 and functions > 0
        tail.ue(functions)
        self.layers, self.body, coder = [1] * self.groups, "", rng.choice([0, 0, 3, 3, 1])
        coder = 0 if self.of_frames and coder == 1 else coder
        if functions:
            attributes = {3: [(2, 2)], 6: [(0, 2), (1, 1), (2, 2)]}.get(functions, [])      # 6.8: behind one function
            if attributes and rng.randrange(3) == 0:
                tail.u(1, 1).u(1, 4).u(0, 4).u(0, 3).u(1, 3).u(0, 2).u(129, 8).u(127, 8).ue(len(attributes))
                for meaning, count in attributes:
                    tail.ue(meaning).ue(count - 1)
            else:
                tail.u(0, 1)
            tail.u(coder, 2).u(self.prediction, 1).u(self.groups - 1, 4)
            if coder == 3:
                self.layers = [1 if self.of_frames else rng.choice([1, 2, 2, 3, 4]) for _ in self.layers]
                for layers in self.layers:
                    tail.u(layers - 1, 2)
            self.cut_layers_bits = 2 * (coder == 3)
            self.body, tail = tail.bits, BitWriter()
            tail.u(self.transform, 1).u(0, 4 if self.transform else 0)
            self.coefficients = range_ends(rng, self.bits, self.base, 4)
            tail.ue(len(self.coefficients))
            for end in self.coefficients:
                tail.u(end, 5)
            step = rng.choice([1, 7, 1000, 1 << 18])
            others = [rng.randrange(self.groups) for _ in range(functions - self.groups)]
            for group in list(range(self.groups)) + others:
                tail.ue(0, group).u(0, 4).u(1, 1).ue(step)
        self.head, self.tail = head.bits, tail.bits

    def sequence_payload(self, cut, layers=0):
        """7.2: the sequence unit, with the bits behind sps_cut_flag, "" without it, and sps_cut_layers."""
        writer = BitWriter()
        writer.bits = self.head + ("1" + cut if cut else "0") + self.body
        if cut and self.groups:
            writer.u(layers, self.cut_layers_bits)
        writer.bits += self.tail
        return writer.payload() + self.later

    def coded_units(self):
        """7.1: transforms, slices, the base, and slices in any order that is allowed."""
        if self.transform:
            self.transform_unit()
        slices = BitWriter().ue(len(self.spans) - 1, *[self.start] * (len(self.spans) > 1))
        for s, (first, end) in enumerate(self.spans):
            slices.ue(*[self.cuts[s + 1] - self.cuts[s] - 1] * bool(self.base), end - first - 1)
        self.units.append((text.SLICES, slices.payload()))
        self.field = text.LightField(self.sequence)
        self.field.read_slices(slices.payload())
        for kind in self.sequence.unit_order(True) if self.base else []:
            self.unit_of(None, kind)
        left, done = [self.sequence.unit_order(False) for _ in self.spans], set()
        while any(left):
            s = self.rng.choice([s for s, kinds in enumerate(left) if kinds])
            kind = left[s][0]
            if s and self.start == 0 and kind[0] != text.NORMALS and kind not in done:
                continue
            self.unit_of(s, left[s].pop(0))
            if s == 0:
                done.add(kind)

    def transform_unit(self):
        """7.11: a transform; its columns come with its groups."""
        first = self.rng.randrange(self.groups)
        count = self.rng.randrange(1, self.groups - first + 1)
        functions = sum(len(group) for group in self.sequence.groups[first:first + count])
        joint = self.rng.randrange(2)
        header = BitWriter().ue(first, count - 1).u(joint, 1).ue(self.rng.randrange(functions))
        header = header.u(0, 1 - joint).payload()
        self.sequence.transforms.append(text.Transform(self.sequence, header))
        self.units.append((text.TRANSFORM, header))

    def unit_of(self, number, kind):
        """7.4 - 7.6: a unit of the base (None) or a slice."""
        numbers = [*kind[1:2], *([] if number is None else [number]), *kind[2:]]
        header = BitWriter().ue(*numbers)
        Chooser.queue, Chooser.empty, Chooser.made = None, False, []
        if kind[0] == text.GEOMETRY:
            begin, end = ([0] + self.geometry + [self.bits])[kind[1]:kind[1] + 2]
            Chooser.queue = self.occupancy(number, begin, end)
            if number is None and end == self.base:
                Chooser.queue += self.classes()
        elif kind[0] == text.COEFFICIENTS:
            begin, end = ([0] + self.coefficients + [self.bits])[kind[1]:kind[1] + 2]
            for _ in range(end - begin if self.prediction else 0):
                header.u(*[(self.rng.randrange(4), 2), (self.rng.randrange(8), 3)][self.sequence.predicted])
            Chooser.empty = self.rng.random() < 0.12
        elif kind[0] == text.REFINEMENT:
            Chooser.empty = self.rng.random() < 0.12
        with_matrix = kind[0] == text.COEFFICIENTS and kind[1] == 0 and self.transform and not self.sequence.predicted
        bits = header.bits                          # the matrix is as long as it turns out
        self.field.read_unit(kind[0], text.BitReader((header.ue(0) if with_matrix else header).payload()))
        *matrix, body = [chooser.codeword for chooser in Chooser.made]
        if with_matrix:
            header.bits = bits
            header.ue(len(b"".join(matrix)))
        self.units.append((kind[0], header.payload() + b"".join(matrix) + body))

    def occupancy(self, number, begin, end):
        """8.4.1: the decisions of the levels of a unit."""
        codes = [self.codes[i] for i in self.first] if number is None else self.codes[slice(*self.spans[number])]
        decisions = []
        for level in range(begin, end):
            nodes = {}
            for code in codes:
                child = code >> 3 * (self.bits - level - 1)
                nodes.setdefault(child >> 3, set()).add(child & 7)
            only = self.rng.randrange(2)
            decisions.append(only)
            for children in nodes.values():
                if only and len(children) == 1 and self.rng.random() < 0.95:      # 8.4.6; the rest says it the long way
                    decisions += [1] + [min(children) >> axis & 1 for axis in (2, 1, 0)]
                    continue
                decisions += [0] * only + [int(c in children) for c in range(8)][:7 if children == {7} else 8]
        return decisions

    def classes(self):
        """8.4.5: the decisions of classes: of the cells' points, or by chance, rarely too heavy together."""
        cells, kind = len(self.first), self.rng.randrange(3)
        most = max(k for k in range(23) if cells << k <= (1 << 24) + (self.rng.random() < 0.05) * (1 << 23))
        decisions = []
        for begin, end in zip(self.first, self.first[1:] + [len(self.codes)]):
            k = [round(math.log2(end - begin)), self.rng.randrange(most + 1), most][kind]
            decisions += [1] * k + [0] * (k < 22)
        return decisions

    def cut(self, levels, groups, layers, kept, slices_flag, lost):
        """7.1: the stream without units on purpose, and without the last ones."""
        cut = BitWriter().u(levels, 5).ue(groups).u(slices_flag, 1).bits
        units = [(text.SEQUENCE, self.sequence_payload(cut, layers))]
        for unit_type, payload in self.units[1:]:
            if unit_type in (text.GEOMETRY, text.NORMALS, text.COEFFICIENTS, text.REFINEMENT):
                number, kind = self.sequence.unit_kind(unit_type, text.BitReader(payload))
                if number is not None and (number not in kept or levels <= self.base):
                    continue
                if unit_type in (text.COEFFICIENTS, text.REFINEMENT) and (
                        groups and kind[2] >= groups or self.sequence.coefficient_bounds[kind[1]] >= levels):
                    continue
                if unit_type == text.REFINEMENT and layers and kind[3] >= layers:
                    continue
            units.append((unit_type, payload))
        return stream_of(units[:max(len(units) - lost, 2)])

    def damaged(self):
        """The stream with a bit inverted, or a unit lost, moved or repeated; checksums are right."""
        units, i, j = list(self.units), *[self.rng.randrange(len(self.units)) for _ in range(2)]
        kind = self.rng.randrange(5)
        if kind == 0:
            units.pop(i)
        elif kind == 1:
            units.insert(j, units[i])
        elif kind == 2:
            units[i], units[j] = units[j], units[i]
        elif units[i][1]:
            payload = bytearray(units[i][1])
            reach = min(len(payload), 4) if kind == 3 else len(payload)
            payload[self.rng.randrange(reach)] ^= 1 << self.rng.randrange(8)
            units[i] = units[i][0], bytes(payload)
        return stream_of(units)

    def requests(self):
        """Streams and what is asked of them: levels, groups, layers, region."""
        rng, data, side = self.rng, stream_of(self.units), 1 << self.bits
        groups = rng.randrange(self.groups) + 1 if self.groups else 0
        low = [rng.randrange(side) for _ in range(3)]
        region = low + [min(side - 1, v + rng.randrange(side // 2 + 1)) for v in low]
        most = max(self.layers, default=1)
        layers = rng.randrange(1, most + 1)
        yield data, 0, 0, 0, []
        yield data, rng.randrange(1, self.bits + 1), 0, 0, []
        yield data, rng.choice([0, rng.randrange(1, self.bits + 1)]), groups, 0, []
        yield data, rng.choice([0, rng.randrange(1, self.bits + 1)]), 0, 0, region
        if most > 1:
            yield data, 0, 0, layers, []
            yield data, rng.randrange(1, self.bits + 1), groups, layers, []
        prefix = SIGNATURE + b"".join(unit(*each) for each in self.units[:rng.randrange(1, len(self.units))])
        yield prefix, rng.choice([0, rng.randrange(1, self.bits + 1)]), 0, 0, []
        kept = {s for s in range(len(self.spans)) if rng.randrange(2)}
        kept |= {0} if self.start == 0 or not self.base else set()
        levels = rng.choice([self.bits, rng.randrange(1, self.bits + 1)])
        slices_flag, lost = rng.randrange(2) if self.base else 0, rng.choice([0, 2, 5])
        cut = self.cut(levels, rng.choice([0, groups]), rng.choice([0, layers % most]), kept, slices_flag, lost)
        yield cut, rng.choice([0, rng.randrange(1, self.bits + 1)]), 0, 0, []
        for _ in range(3):
            yield self.damaged(), 0, 0, 0, []
