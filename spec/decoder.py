#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An independent decoder, written from the text of slf-bitstream.md alone; slow; for reading beside the
specification and as a second opinion in the conformance tests.

    decoder.py decode STREAM.slf [--dump DIRECTORY] [--planes] [--levels N] [--groups N] [--region BOX]

Decodes to the integer conformance point and leaves positions.npy (int32 [P, 3]), components.npy (int32
[P, R, 3]), with --planes planes.npy (int32 [P, K, 3]) and, where the stream has normals, octahedral.npy
(uint16 [P, 2]) in DIRECTORY, and light_field.json with the header. --levels keeps the
first N levels of the grid, --groups the first N groups of functions, --region x0,y0,z0,x1,y1,z1 what meets a
box of the world (clause 8.9). A light field that moves (clause 7.13) is decoded frame after frame: a line for each, and the files of frame n in
DIRECTORY/frame_n. Exit code: 0 decoded, 1 refused, with the syntax element in question on standard error.

Needs Python 3 (3.10 or later) and numpy, and for the pictures of profile 2 (textures) libde265, by hevc.py;
without it they are refused. Profile 1 (Draco geometry, clause 8.5) is not decoded but refused. Beyond 2^28
component values in a stream it refuses too (clause 9). Numbers in docstrings are clauses.
"""
import argparse
import hashlib
import itertools
import json
import math
import os
import struct
import sys
import zlib

import numpy as np

import hevc

SEQUENCE, SLICES, GEOMETRY, NORMALS, COEFFICIENTS = 1, 2, 3, 4, 5
INDEX, METADATA, DIGEST, TRANSFORM, REFINEMENT, FRAME, FILLER, END = 6, 7, 8, 9, 10, 11, 14, 15
OF_POINTS = {SLICES, GEOMETRY, NORMALS, COEFFICIENTS, DIGEST, TRANSFORM, REFINEMENT}
MAX_VALUES = 1 << 28
LEVELS = ((math.inf,) * 4, (1 << 20, 1 << 26, 1 << 24, 1 << 22), (1 << 24, 1 << 30, 1 << 28, 1 << 25))    # table 9-1


class Refused(Exception):
    """3.3: the stream does not conform, or is not supported; names the syntax element."""
    said = "refused"


class Unsupported(Refused):
    """3.4: a later version may have given the value a meaning."""
    said = "unsupported"


def require(condition, element, refusal=Refused):
    """3.3, 3.4: a value outside its range is reported, and there is no light field."""
    if not condition:
        raise refusal(element)


# ---- 3 Conventions

class BitReader:
    """3.3: reads a payload, most significant bit first."""

    def __init__(self, data):
        """3.3: starts at the first bit of the payload."""
        self.data = data
        self.position = 0
        self.elements = {}                  # the last value of each by name

    def u(self, bits, element):
        """3.3: u(n), unsigned."""
        end = self.position + bits
        require(end <= 8 * len(self.data), element + " (truncated)")
        window = int.from_bytes(self.data[self.position // 8:(end + 7) // 8], "big")
        self.position = end
        return self.noted(element, (window >> (-end % 8)) & ((1 << bits) - 1))

    def noted(self, element, value):
        """3.3: the value of an element, which is kept."""
        self.elements[element] = value
        return value

    def s8(self, element):
        """3.3: s(8), two's complement."""
        value = self.u(8, element)
        return self.noted(element, value - 256 if value >= 128 else value)

    def ue(self, element):
        """3.3: ue(v), Exp-Golomb of order 0."""
        zeros = 0
        while self.u(1, element) == 0:
            zeros += 1
            require(zeros <= 31, element)
        return self.noted(element, (1 << zeros) - 1 + self.u(zeros, element))

    def se(self, element):
        """3.3: se(v), 0, 1, 2, 3, 4 for 0, 1, -1, 2, -2."""
        value = self.ue(element)
        return (value + 1) // 2 if value % 2 else -(value // 2)

    def f64(self, element):
        """3.3: f(64), a finite double."""
        value = struct.unpack(">d", self.u(64, element).to_bytes(8, "big"))[0]
        require(math.isfinite(value), element)
        return self.noted(element, value)

    def align(self, element="alignment_zero_bits"):
        """3.3: zero bits to the next byte."""
        require(self.u(-self.position % 8, element) == 0, element)

    def trailing_bits(self, element):
        """3.3: the end of a header, which nothing may follow."""
        self.align(element)
        require(self.position == 8 * len(self.data), element)

    def rest(self):
        """3.3: zero bits to the next byte, then the bytes that are left."""
        self.align()
        return self.data[self.position // 8:]


# ---- 6 The light field

def morton(x, y, z):
    """6.2: the Morton code of a position."""
    code = 0
    for i in range(21):
        code |= (x >> i & 1) << 3 * i | (y >> i & 1) << 3 * i + 1 | (z >> i & 1) << 3 * i + 2
    return code


def from_morton(code):
    """6.2: the position of a Morton code."""
    return tuple(sum((code >> 3 * i + axis & 1) << i for i in range(21)) for axis in range(3))


# ---- 7 Syntax

SIGNATURE = bytes.fromhex("8B534C460D0A1A0A")


def behind_version(data, position):
    """7.1, 7.1.2: where unit_length of a unit stands; the version of a sequence unit is checked. None where the data end before it."""
    if data[position] != SEQUENCE:
        return position + 1
    if position + 3 > len(data):
        return None
    require(data[position + 1] == 1, "sps_version_major", Unsupported)
    return position + 3


def read_units(data, predicted=False):
    """7.1: the units of a stream of one frame, or of a frame, as (type, payload, size of the whole unit)."""
    require(predicted or data[:8] == SIGNATURE, "signature")
    position, units = 0 if predicted else 8, []
    while position < len(data):
        start = position
        position = behind_version(data, start)
        require(position, "sps_version_major (truncated)")
        length = shift = 0
        while True:
            require(shift < 6 * 7, "unit_length")
            require(position < len(data), "unit_length (truncated)")
            byte = data[position]
            position += 1
            length |= (byte & 127) << shift
            if byte < 128:
                require(byte or shift == 0, "unit_length")
                break
            shift += 7
        end = position + length
        require(end + 4 <= len(data), "unit_payload (truncated)")
        require(zlib.crc32(data[start:end]) == int.from_bytes(data[end:end + 4], "big"), "unit_crc")
        units.append((data[start], data[position:end], end + 4 - start))
        position = end + 4
        require(data[start] != END or position == len(data), "end_of_stream")
    require(units and units[0][0] == (FRAME if predicted else SEQUENCE), "unit_type")
    return units


def unit_at(data, position):
    """7.1: payload and end of the unit at a place; None where the data end before it does."""
    size = shift = 0
    behind = behind_version(data, position) or len(data)
    for at in range(behind, min(behind + 6, len(data))):
        size |= (data[at] & 127) << shift
        shift += 7
        if data[at] < 128:
            end = at + 1 + size
            if end + 4 > len(data):
                return None
            require(zlib.crc32(data[position:end]) == int.from_bytes(data[end:end + 4], "big"), "unit_crc")
            return data[at + 1:end], end + 4
    return None


def split_frames(data):
    """7.13: the frame unit, None of a light field that does not move, and the bytes of every frame."""
    position, before = 0, None
    if len(data) <= len(SIGNATURE):         # no unit; whoever reads them says so
        yield None, data
        return
    while position < len(data):
        intra, at = data[position:position + 8] == SIGNATURE, position
        if before:                          # not even the beginning of a frame?
            like = SIGNATURE[:len(data) - position]
            require(data[position] != SIGNATURE[0] or data[position:position + 8] == like, "signature")
            require(data[position] in (SIGNATURE[0], FRAME), "unit_type")
        if intra:
            try:
                sequence = unit_at(data, position + 8)
            except Refused:
                if before:
                    raise
                sequence = None             # whoever reads the units of the one frame says why
            at = sequence[1] if sequence else len(data)
        if before is None and (not intra or at >= len(data) or data[at] != FRAME):
            yield None, data
            return
        found = unit_at(data, at)
        if found is None and before:
            return                          # the stream ends in it
        require(found, "unit_payload (truncated)")
        require(data[at] == FRAME, "unit_type")
        frame = Frame(found[0])
        require(frame.predicted != intra, "frame_predicted_flag")
        if before:
            require(frame.number == before.number + 1, "frame_number")
            require(frame.time > before.time, "frame_time")
        yield frame, data[position:found[1] + frame.bytes]
        position, before = found[1] + frame.bytes, frame


class Sequence:
    """7.2: the parameters of the stream."""

    def __init__(self, payload):
        """7.2: parses the sequence unit."""
        reader = BitReader(payload)

        def checked(bits, accept, element, refusal=Refused):
            """7.2: an unsigned element and its range."""
            value = reader.u(bits, element)
            require(accept(value), element, refusal)
            return value

        profile = checked(4, lambda v: v <= 2, "sps_profile", Unsupported)
        self.level = checked(4, lambda v: v <= 2, "sps_level", Unsupported)
        self.grid_bits = checked(5, lambda v: v <= 20, "sps_grid_bits_minus1", Unsupported) + 1
        self.origin, self.step = [0.0] * 3, 1.0
        if not reader.u(1, "sps_unit_grid_flag"):
            self.origin = [reader.f64("sps_origin") for _ in range(3)]
            self.step = reader.f64("sps_step")
            require(self.step > 0, "sps_step")
        checked(3, lambda v: v <= 6, "sps_up_axis", Unsupported)
        reader.u(1, "sps_left_handed_flag")
        if reader.u(1, "sps_metres_flag"):
            require(reader.f64("sps_metres_per_unit") > 0, "sps_metres_per_unit")
        geometry_coder = checked(2, lambda v: v <= 1, "sps_geometry_coder", Unsupported)
        require(geometry_coder == (profile == 1), "sps_geometry_coder")
        self.normal_bits = checked(4, lambda v: v == 0 or 4 <= v <= 12, "sps_normal_bits", Unsupported)
        self.base_and_cut(reader, checked, profile)
        self.geometry_bounds = self.level_ranges(reader, "geometry")
        require(profile != 1 or len(self.geometry_bounds) == 2, "sps_num_geometry_ranges_minus1")
        self.functions = reader.ue("sps_num_functions")
        require(self.functions <= 4096, "sps_num_functions")
        self.coefficient_bounds = [0]
        self.texture = profile == 2
        self.prediction = self.predicted = False
        self.attributes = []                # (id, functions) of each
        self.groups = []                    # functions of each group
        self.layers = []                    # quality layers of each group
        self.steps = []                     # three steps of each function
        self.shifts = []                    # of each function
        self.num_transforms, self.transforms = 0, []
        if self.functions:
            if reader.u(1, "sps_basis_flag"):
                if checked(4, lambda v: v <= 1, "sps_basis_idc", Unsupported) == 0:
                    reader.u(2, "sps_order_minus1")
                    scales = checked(3, lambda v: v <= 6, "sps_scales_theta", Unsupported)
                    scales += checked(3, lambda v: v <= 6, "sps_scales_gamma", Unsupported)
                    of_basis = 1 << scales
                else:
                    degree = checked(4, lambda v: v <= 10, "sps_degree", Unsupported)
                    of_basis = (degree + 1) ** 2
                frame = checked(3, lambda v: v <= 1, "sps_directions_idc", Unsupported)
                checked(3, lambda v: v <= 1, "sps_colour_idc", Unsupported)
                checked(2, lambda v: v <= 1, "sps_transfer_idc", Unsupported)
                gamma_min, gamma_max = reader.s8("sps_gamma_min"), reader.s8("sps_gamma_max")
                require(gamma_min >= -127, "sps_gamma_min")
                require(gamma_max >= gamma_min, "sps_gamma_max")
                if frame == 1:
                    checked(5, lambda v: v < self.grid_bits, "sps_normal_cell_log2")
                of_attributes = self.read_attributes(reader)
                require(self.functions == of_basis + of_attributes, "sps_num_functions")
            coder = checked(2, lambda v: (v == 2) == (profile == 2), "sps_coefficient_coder")
            self.coder = (VectorCoder, IndependentCoder, None, VectorCoder)[coder]
            if coder == 2:
                self.texture_bits = 8 + 2 * checked(2, lambda v: v <= 2, "sps_texture_bits", Unsupported)
                self.texture_cell_log2 = reader.u(3, "sps_texture_cell_log2")
            else:
                self.prediction = bool(reader.u(1, "sps_prediction_flag"))
            self.groups = [[] for _ in range(reader.u(4, "sps_num_groups_minus1") + 1)]
            self.layers = [1] * len(self.groups)
            if coder == 3:
                self.layers = [reader.u(2, "sps_num_layers_minus1") + 1 for _ in self.groups]
                if self.cut:
                    self.cut_layers = checked(2, lambda v: v < max(self.layers), "sps_cut_layers")
            if checked(1, lambda v: coder != 2 or v == 0, "sps_transform_flag"):
                self.num_transforms = 1
            if self.num_transforms:
                self.num_transforms += checked(4, lambda v: v < len(self.groups), "sps_num_transforms_minus1")
            self.coefficient_bounds = self.level_ranges(reader, "coefficient")
            require(coder != 2 or len(self.coefficient_bounds) == 2, "sps_num_coefficient_ranges_minus1")
            while len(self.steps) < self.functions:
                self.plane_run(reader)
        self.elements = dict(reader.elements)
        reader.align("sps_trailing_bits")
        self.features = self.later_elements(reader)
        require(all(self.groups), "sps_num_groups_minus1")
        require(self.cut_groups <= len(self.groups), "sps_cut_groups")
        require(profile != 1, "sps_profile (Draco geometry is not supported)", Unsupported)
        self.profile = profile
        self.coded = list(self.groups)      # those in whose place components stand

    @staticmethod
    def later_elements(reader):
        """7.2.1: features, as a set of those that are known, and what is skipped."""
        left, features = len(reader.data) - reader.position // 8, set()
        if left:
            for i in range(32):
                if reader.u(1, f"sps_feature[{i}]"):
                    require(i in (BY_REFERENCE, EMPTY, MOVED), f"sps_feature[{i}]", Unsupported)
                    features.add(i)
            require(left - 4 <= 1 << 16, "sps_extension")
        return features

    def read_attributes(self, reader):
        """7.2, 6.8: what is no view map; the number of functions of all."""
        count = reader.ue("sps_num_attributes")
        require(count <= 16, "sps_num_attributes")
        for _ in range(count):
            meaning = reader.ue("sps_attribute_id")
            require(meaning <= 2, "sps_attribute_id", Unsupported)
            require(meaning == 0 or all(meaning != other for other, _ in self.attributes), "sps_attribute_id")
            functions = reader.ue("sps_attribute_functions_minus1") + 1
            require(functions == meaning or meaning == 0 and functions <= 4096, "sps_attribute_functions_minus1")
            self.attributes.append((meaning, functions))
        return sum(functions for _, functions in self.attributes)

    def coded_functions(self, groups):
        """8.7.1: the functions that the components of the first groups stand for, ascending; 0: of all groups."""
        return sorted(k for functions in self.coded[:groups or None] for k in functions)

    def level_ranges(self, reader, kind):
        """7.2: the first level of every range, and grid_bits after the last."""
        count = reader.ue(f"sps_num_{kind}_ranges_minus1")
        require(count <= self.grid_bits - 1, f"sps_num_{kind}_ranges_minus1")
        bounds = [0]
        for _ in range(count):
            end = reader.u(5, f"sps_{kind}_range_end")
            require(bounds[-1] < end <= self.grid_bits - 1, f"sps_{kind}_range_end")
            bounds.append(end)
        require(self.base_levels in bounds, "sps_base_levels")
        return bounds + [self.grid_bits]

    def base_and_cut(self, reader, checked, profile):
        """7.2: the base, and what was left out."""
        most = 0 if profile else self.grid_bits - 1
        self.base_levels = checked(5, lambda v: v <= most, "sps_base_levels")
        self.cut = reader.u(1, "sps_cut_flag")
        self.cut_levels, self.cut_groups, self.cut_layers, self.cut_slices = self.grid_bits, 0, 0, 0
        if self.cut:
            self.cut_levels = checked(5, lambda v: 1 <= v <= self.grid_bits, "sps_cut_levels")
            self.cut_groups = reader.ue("sps_cut_groups")
            require(self.cut_groups <= 16, "sps_cut_groups")
            self.cut_slices = reader.u(1, "sps_cut_slices_flag")

    def unit_kind(self, unit_type, reader, prefix=""):
        """7.4 - 7.6, 7.9: the numbers a unit begins with: slice (None: the base), (type, level_range, plane_group, layer)."""
        kind, base = [unit_type], False
        if unit_type in (GEOMETRY, COEFFICIENTS, REFINEMENT):
            bounds = self.geometry_bounds if unit_type == GEOMETRY else self.coefficient_bounds
            kind.append(reader.ue(prefix + "level_range"))
            require(kind[1] < len(bounds) - 1, prefix + "level_range")
            base = bounds[kind[1] + 1] <= self.base_levels
        part = None if base else reader.ue(prefix + "slice_id")
        if unit_type in (COEFFICIENTS, REFINEMENT):
            kind.append(reader.ue(prefix + "plane_group"))
            require(kind[2] < len(self.groups), prefix + "plane_group")
        if unit_type == REFINEMENT:
            kind.append(reader.ue(prefix + "refinement_layer"))
            require(1 <= kind[3] <= 3, prefix + "refinement_layer")
        return part, tuple(kind)

    def unit_order(self, base):
        """7.1: the kinds of the units of the base, or of a slice, in their order, without the digest."""
        groups = range(self.cut_groups or len(self.groups))

        def ranges(bounds):
            """2: the ranges of the base, or the others."""
            return [r for r in range(len(bounds) - 1) if (bounds[r + 1] <= self.base_levels) == base]
        normals = [(NORMALS,)] if self.normal_bits and not base else []
        kept = [r for r in ranges(self.coefficient_bounds) if self.coefficient_bounds[r] < self.cut_levels]
        coefficients = [(COEFFICIENTS, r, group) for r in kept for group in groups]
        refinements = [(REFINEMENT, r, group, layer) for layer in range(1, self.cut_layers or max(self.layers, default=1))
                       for r in kept for group in groups if self.layers[group] > layer]
        return [(GEOMETRY, r) for r in ranges(self.geometry_bounds)] + normals + coefficients + refinements

    def plane_run(self, reader):
        """7.2: plane_run( ), functions of one group, shift and steps."""
        length = reader.ue("sps_run_length_minus1") + 1
        require(length <= self.functions - len(self.steps), "sps_run_length_minus1")
        group = reader.ue("sps_plane_group")
        require(group < len(self.groups), "sps_plane_group")
        shift = reader.u(4, "sps_plane_shift")
        equal = reader.u(1, "sps_equal_steps_flag")
        steps = [reader.ue("sps_plane_step") for _ in range(1 if equal else 3)]
        require(all(1 <= step < 1 << 27 for step in steps), "sps_plane_step")
        for _ in range(length):
            self.groups[group].append(len(self.steps))
            self.steps.append(steps * 3 if equal else steps)
            self.shifts.append(shift)


def header_of(sequence, shift):
    """6, 8.9.2: what the sequence unit says, in words; the grid is that of what is given out, 2^shift coarser."""
    e = sequence.elements
    half = sequence.step * ((1 << shift) - 1) / 2
    header = {"grid": {"origin": [v + half for v in sequence.origin], "step": sequence.step * (1 << shift),
                       "bits": sequence.grid_bits - shift},
              "up": ("+x", "-x", "+y", "-y", "+z", "-z", "unknown")[e["sps_up_axis"]],
              "right_handed": not e["sps_left_handed_flag"],
              "metres_per_unit": e.get("sps_metres_per_unit", 0.0),
              "num_functions": sequence.functions, "shift": sequence.shifts,
              "has_basis": bool(e.get("sps_basis_flag"))}
    if sequence.attributes:
        header["attributes"] = [{"id": i, "functions": n} for i, n in sequence.attributes]
    if not header["has_basis"]:
        return header
    if e["sps_basis_idc"] == 0:
        header["basis"] = {"id": "bspline", "order": e["sps_order_minus1"] + 1,
                           "scales_theta": e["sps_scales_theta"], "scales_gamma": e["sps_scales_gamma"]}
    else:
        header["basis"] = {"id": "harmonics", "degree": e["sps_degree"]}
    header["directions"] = ("world", "reflected")[e["sps_directions_idc"]]
    if e["sps_directions_idc"] == 1:
        header["normal_cell"] = 1 << max(e["sps_normal_cell_log2"] - shift, 0)      # 6.6
    header["colour"] = {"transform": ("none", "opponent")[e["sps_colour_idc"]]}
    header["transfer"] = ("display", "linear")[e["sps_transfer_idc"]]
    header["gamma_range"] = [e["sps_gamma_min"] / 127, e["sps_gamma_max"] / 127]
    return header


class Transform:
    """7.11: a transform across planes."""

    def __init__(self, sequence, payload):
        """7.11: parses the unit, and takes the functions behind the rank from those coded. The matrix is 0 as yet."""
        reader = BitReader(payload)
        self.first = reader.ue("tr_first_group")
        before = sequence.transforms[-1].end if sequence.transforms else 0
        require(before <= self.first < len(sequence.groups), "tr_first_group")
        self.end = self.first + reader.ue("tr_num_groups_minus1") + 1
        require(self.end <= len(sequence.groups), "tr_num_groups_minus1")
        functions = [k for group in sequence.groups[self.first:self.end] for k in group]
        self.joint = reader.u(1, "tr_joint_flag")
        rank = reader.ue("tr_rank_minus1") + 1
        self.colour = np.eye(3, dtype=np.int64) * 512
        if not self.joint and reader.u(1, "tr_colour_flag"):
            self.colour = np.array([reader.se("tr_colour") for _ in range(9)], np.int64).reshape(3, 3)
            require(abs(self.colour).max() <= 512, "tr_colour")
        lanes = 1 if self.joint else 3
        rows, columns = len(functions) * 3 // lanes, rank * 3 // lanes
        require(rank <= len(functions) and rows * columns <= 1 << 20, "tr_rank_minus1")
        reader.trailing_bits("tr_trailing_bits")
        self.functions, self.rank, self.columns = functions, rank, {}
        self.matrix = np.zeros((rows, columns), np.int64)
        for g in range(self.first, self.end):
            begin = self.rank - rank
            sequence.coded[g], rank = sequence.groups[g][:rank], max(rank - len(sequence.groups[g]), 0)
            self.columns[g] = range(begin * 3 // lanes, (begin + len(sequence.coded[g])) * 3 // lanes)

    def read_columns(self, decoder, group):
        """7.11: the columns of the functions of a group."""
        self.matrix[:, self.columns[group]] = self.read_matrix(decoder, len(self.matrix), len(self.columns[group]))

    @staticmethod
    def read_matrix(decoder, rows, columns):
        """7.11: so many columns, [rows, columns], with 14 fractional bits."""
        nonzero, magnitudes = Contexts(16), [MagnitudeContexts() for _ in range(16)]
        matrix = np.zeros((rows, columns), np.int64)
        for column in range(columns):
            precision = decoder.raw(4)
            require(precision <= 14, "cu_matrix")
            expected = (16 << precision) // math.isqrt(rows)
            for row in range(rows):
                context, value = min(expected.bit_length(), 15), 0
                if decoder.adaptive(nonzero, context, 255):
                    value = decoder.magnitude(magnitudes[context], 255, "cu_matrix")
                    entry = value << 14 - precision
                    require(entry <= 1 << 20, "cu_matrix")
                    matrix[row, column] = -entry if decoder.raw(1) else entry
                expected = (3 * expected + 16 * value) // 4
        decoder.finish("cu_matrix")
        return matrix

    def expand(self, components, place):
        """8.7.5: the values of its functions, [P, S, 3]; place has the functions whose components there are."""
        there = [place[k] for k in self.functions[:self.rank] if k in place]
        lanes = 1 if self.joint else 3
        some = components[:, there]
        if not self.joint:
            some = clamp31(some @ self.colour.T + 256 >> 9)
        some = some.reshape(len(some), -1, lanes)
        values = np.einsum("kr,prc->pkc", self.matrix[:, :some.shape[1]], some) + (1 << 13) >> 14
        return clamp31(values).reshape(len(values), -1, 3)


def clamp31(values):
    """8.7.5: what 32 bits hold."""
    return np.clip(values, 1 - 2**31, 2**31 - 1)


def given_planes(sequence, coded, components):
    """8.7.5: the planes of all functions, [P, K, 3], of the components that stand for the functions coded."""
    planes = np.zeros((len(components), sequence.functions, 3), np.int64)
    planes[:, coded] = components
    for transform in sequence.transforms:
        planes[:, transform.functions] = transform.expand(components, {k: r for r, k in enumerate(coded)})
    return planes


class Frame:
    """7.13: the frame unit."""

    def __init__(self, payload):
        """7.13: parses the unit but for the vectors of a lattice, which need the reference."""
        reader = BitReader(payload)
        self.number = reader.ue("frame_number")
        require(self.number < 1 << 31, "frame_number")
        self.time = reader.f64("frame_time")
        self.predicted = bool(reader.u(1, "frame_predicted_flag"))
        self.bytes = reader.ue("frame_bytes")
        require(self.bytes < 1 << 31, "frame_bytes")
        self.matrix, self.shift, self.lattice_log2, self.moves = [[0] * 3 for _ in range(3)], [0] * 3, 0, False
        if self.predicted and reader.u(1, "frame_motion_flag"):
            self.read_motion(reader)
        self.codeword, self.vectors = reader.rest(), None
        require(self.lattice_log2 or self.moves or not self.codeword, "frame_vectors")

    def read_motion(self, reader):
        """7.13: frame_motion( )."""
        self.matrix = [[reader.se("frame_matrix") for _ in range(3)] for _ in range(3)]
        require(all(abs(entry) < 1 << 17 for row in self.matrix for entry in row), "frame_matrix")
        self.shift = [reader.se("frame_shift") for _ in range(3)]
        require(all(abs(part) < 1 << 20 for part in self.shift), "frame_shift")
        if not reader.u(1, "frame_lattice_flag"):
            return
        says = reader.u(4, "frame_lattice_log2")
        require(says == 0 or 3 <= says <= 14, "frame_lattice_log2", Unsupported)
        self.moves, self.lattice_log2 = says == 0 or says > 8, says if says <= 8 else says - 6
        if says == 0:
            return
        self.first = [reader.ue("frame_lattice_first") for _ in range(3)]
        require(max(self.first) < 1 << 18, "frame_lattice_first")
        self.size = [reader.ue("frame_lattice_size_minus1") + 1 for _ in range(3)]
        require(math.prod(self.size) <= 1 << 18, "frame_lattice_size_minus1")

    def read_vectors(self, cells):
        """7.13: the codeword; cells are those of the reference, of all levels."""
        decoder = ArithmeticDecoder(self.codeword)
        if self.lattice_log2:
            self.read_lattice(decoder, cells)
        if self.moves:
            self.read_points(decoder, len(cells[-1]))
        if self.lattice_log2 or self.moves:
            decoder.finish("frame_vectors")

    def read_points(self, decoder, points):
        """7.13: the vectors of the points of the reference."""
        moving, nonzero = Contexts(3), [Contexts(3) for _ in range(3)]
        magnitudes, self.vectors_of_points, before = [MagnitudeContexts() for _ in range(3)], [], [0, 0]
        for _ in range(points):
            before.append(decoder.adaptive(moving, sum(before[-2:]), 255))
            vector, busy = [0] * 3, 0
            if before[-1]:
                for i in range(3):
                    if decoder.adaptive(nonzero[i], busy, 255):
                        size = decoder.magnitude(magnitudes[i], 255, "frame_vectors")
                        require(size <= 1 << 21, "frame_vectors")
                        vector[i] = -size if decoder.raw(1) else size
                        busy += 1
            self.vectors_of_points.append(vector)

    def read_lattice(self, decoder, cells):
        """7.13: the vectors of the lattice, by point."""
        level, self.vectors = len(cells) - 1 - self.lattice_log2, {}
        nonzero, magnitudes = [Contexts(3) for _ in range(3)], [MagnitudeContexts() for _ in range(3)]
        for z, y, x in itertools.product(*map(range, self.size[::-1])):
            point = x, y, z
            self.vectors[point] = [0] * 3
            around_point = itertools.product(*[range(n + a - 2, n + a + 2) for n, a in zip(self.first, point)])
            if level >= 0 and not any(cell in cells[level] for cell in around_point):
                continue
            before = [self.vectors[tuple(a - (i == k) for i, a in enumerate(point))] for k in range(3) if point[k]]
            busy = 0
            for i in range(3):
                total = sum(vector[i] for vector in before)
                value = abs(total) // max(len(before), 1) * (-1 if total < 0 else 1)
                if decoder.adaptive(nonzero[i], busy, 255):
                    rest = decoder.magnitude(magnitudes[i], 255, "frame_vectors")
                    value += -rest if decoder.raw(1) else rest
                    require(rest <= 1 << 16 and abs(value) <= 1 << 16, "frame_vectors")
                    busy += 1
                self.vectors[point][i] = value


class Slices:
    """7.3: the runs of base cells."""

    def __init__(self, sequence, payload):
        """7.3: parses the slices unit."""
        reader = BitReader(payload)
        count = reader.ue("slices_num_minus1") + 1
        require(count <= 1 << 16 and (sequence.base_levels or count == 1), "slices_num_minus1")
        require(count <= 8 * len(payload), "slices_num_minus1 (truncated)")
        start = reader.ue("slices_start") if count > 1 else 1
        require(start <= 2, "slices_start", Unsupported)
        self.shared, self.apart = start == 0, start == 2
        self.cells, self.points = [], []
        for _ in range(count):
            self.cells.append(reader.ue("slice_num_cells_minus1") + 1 if sequence.base_levels else 1)
            self.points.append(reader.ue("slice_num_points_minus1") + 1)
            require(self.cells[-1] <= 1 << 22, "slice_num_cells_minus1")
            require(self.cells[-1] <= self.points[-1] <= 1 << 22, "slice_num_points_minus1")
        reader.trailing_bits("slices_trailing_bits")
        require(sum(self.cells) <= 1 << 22, "slice_num_cells_minus1")
        self.first_cell = [sum(self.cells[:s]) for s in range(count)]
        require(sum(self.points) * 3 * sequence.functions <= MAX_VALUES,
                "slice_num_points_minus1 (beyond this decoder's limit)")


def check_index(sequence, payload, following):
    """7.7: the index agrees with the units that follow it, as far as the stream goes; its boxes, None without."""
    reader = BitReader(payload)
    count = reader.ue("index_num_units")
    whole = following and following[-1][0] == END
    require(count == len(following) if whole else count >= len(following), "index_num_units")
    for i in range(count):
        unit_type, size = reader.u(8, "index_unit_type"), reader.ue("index_unit_bytes")
        named = unit_type in (GEOMETRY, NORMALS, COEFFICIENTS, DIGEST, REFINEMENT)
        numbers = sequence.unit_kind(unit_type, reader, "index_") if named else (0,)
        require((numbers[0] or 0) < 1 << 16, "index_slice_id")
        if i < len(following):
            require(unit_type == following[i][0], "index_unit_type")
            require(size == following[i][2], "index_unit_bytes")
            require(not named or numbers == sequence.unit_kind(unit_type, BitReader(following[i][1])), "index_unit_ids")
    boxes = None
    bits = sequence.base_levels
    require(reader.u(1, "index_boxes_flag") == (bits > 0), "index_boxes_flag")
    if bits:
        count = reader.ue("index_num_slices_minus1") + 1
        require(6 * bits * count <= 8 * len(payload), "index_num_slices_minus1")
        boxes = [[reader.u(bits, "index_box") for _ in range(6)] for _ in range(count)]
    reader.trailing_bits("index_trailing_bits")
    return boxes


def check_boxes(boxes, slices, cells):
    """7.7: the boxes of an index are those of the base cells; cells is None where these are not known."""
    require(len(boxes) == len(slices.cells), "index_num_slices_minus1")
    for box, first, count in zip(boxes, slices.first_cell, slices.cells):
        if cells is not None:
            run = cells[first:first + count]
            require(box == [min(axis) for axis in zip(*run)] + [max(axis) for axis in zip(*run)], "index_box")


def check_metadata(payload):
    """7.8: the metadata inflates to pairs of a key, not empty, and a value."""
    reader = BitReader(payload)
    size = reader.ue("metadata_bytes")
    require(size <= 1 << 20, "metadata_bytes")
    inflater = zlib.decompressobj()
    try:
        text = inflater.decompress(reader.rest(), size + 1)
    except zlib.error:
        raise Refused("metadata_deflated") from None
    require(inflater.eof and not inflater.unused_data and len(text) == size, "metadata_deflated")
    try:
        text.decode("utf-8")
    except UnicodeDecodeError:
        raise Refused("metadata_text") from None
    fields = text.split(b"\0")
    require(fields.pop() == b"" and len(fields) % 2 == 0 and all(fields[::2]), "metadata_text")


def check_digest(digest, positions, components, normals):
    """7.9: SHA-256 of sums over runs of 64 points; normals is None where the stream has none."""
    numbers = [*positions.T, *components.reshape(len(positions), -1).T]
    if normals is not None:
        numbers += [*normals.T]
    hashes = np.zeros(len(positions), np.uint64)  # sums wrap at 2^64
    multiplier = 1
    for of_points in numbers:
        multiplier = multiplier * 0x9E3779B5 % 2**32
        hashes += (of_points.astype(np.int64) & 0xFFFFFFFF).astype(np.uint64) * np.uint64(multiplier)
    runs = []
    for begin in range(0, len(hashes), 64):
        run = 0
        for value in hashes[begin : begin + 64].tolist():
            run = (run * 0x9E3779B97F4A7C15 + value) % 2**64
        runs.append(run)
    require(hashlib.sha256(np.array(runs, "<u8").tobytes()).digest() == digest, "digest_sha256")


def check_end(payload, number):
    """7.10: the end unit counts the units before it."""
    reader = BitReader(payload)
    require(reader.ue("end_num_units") == number, "end_num_units")
    reader.trailing_bits("end_trailing_bits")


# ---- 8.3 Arithmetic decoding

RATES = [(131072 + (2 * n + 3) // 2) // (2 * n + 3) for n in range(256)]       # R[n] of 8.3.2


def copied(this, **state):
    """8.1: a copy of an object with other state."""
    other = object.__new__(type(this))
    other.__dict__.update(this.__dict__, **state)
    return other


def copied_all(objects):
    """8.1: copies of several objects."""
    return [each.copy() for each in objects]


class Contexts:
    """8.3.2: a set of contexts: probabilities with 22 fractional bits, and counts."""

    def __init__(self, size):
        """8.3.2: the initial state."""
        self.probability = [1 << 21] * size
        self.count = [0] * size

    def copy(self):
        """8.1: the same state, which does not move with this one."""
        return copied(self, probability=self.probability[:], count=self.count[:])


class MagnitudeContexts:
    """8.3.4: the contexts of a magnitude."""

    def __init__(self):
        """8.3.4: more[14] and prefix[28]."""
        self.more = Contexts(14)
        self.prefix = Contexts(28)

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, more=self.more.copy(), prefix=self.prefix.copy())


class ArithmeticDecoder:
    """8.3.1: decisions out of a codeword."""

    def __init__(self, codeword):
        """8.3.1: the start."""
        self.codeword = codeword
        self.range = (1 << 32) - 1
        self.code = int.from_bytes((codeword + bytes(4))[:4], "big")
        self.consumed = 4

    def decide(self, p):
        """8.3.1: a decision with P(1) = p / 65536."""
        bound = (self.range >> 16) * p
        if self.code < bound:
            bit = 1
            self.range = bound
        else:
            bit = 0
            self.code -= bound
            self.range -= bound
        while self.range < 1 << 24:
            byte = self.codeword[self.consumed] if self.consumed < len(self.codeword) else 0
            self.consumed += 1
            self.range <<= 8
            self.code = self.code << 8 | byte
        return bit

    def raw(self, bits):
        """8.3.1: raw(n)."""
        value = 0
        for _ in range(bits):
            value = value << 1 | self.decide(1 << 15)
        return value

    def finish(self, element):
        """8.3.1: the bytes consumed at the end of a unit."""
        require(self.consumed >= len(self.codeword), element + " (longer)")
        require(self.consumed <= len(self.codeword) + 4, element + " (truncated)")

    def adaptive(self, contexts, index, limit):
        """8.3.2: a decision in a context, which adapts."""
        before, count = contexts.probability[index], contexts.count[index]
        bit = self.decide(max(before >> 6, 1))
        target = (1 << 22) - 1 if bit else 0
        contexts.probability[index] = before + ((target - before) * RATES[count] >> 16)
        if count < limit:
            contexts.count[index] = count + 1
        return bit

    def magnitude(self, contexts, limit, element):
        """8.3.4: a magnitude of 1 or more."""
        for value in range(1, 15):
            if not self.adaptive(contexts.more, value - 1, limit):
                return value
        return 14 + self.exp_golomb(contexts.prefix, limit, element)

    def exp_golomb(self, prefix, limit, element):
        """8.3.4: the rest of a magnitude, 1 or more."""
        length = 0
        while self.adaptive(prefix, length, limit):
            length += 1
            require(length < 28, element)
        return (1 << length) + self.raw(length)


TABLE_A1 = [int(word) for word in """
32768 36843 40793 44511 47911 50941 53581 55834 57724 59287 60565 61598 62428 63090 63615 64030 64357 64614
64816 64974 65097 65194 65269 65328 65374 65410 65438 65459 65476 65489 65500 65508 65514 65519 65523 65526
65528 65530 65531 65532 65533 65534 65534 65535 65535""".split()]


def squash(x):
    """8.3.3: logistic value, in 1/256, to probability."""
    a = min(abs(x), 2815)
    i = a // 64
    p = TABLE_A1[i] + ((TABLE_A1[i + 1] - TABLE_A1[i]) * (a % 64) >> 6)
    return 65536 - p if x < 0 else p


def stretch_table():
    """8.3.3: stretch(p) for every p >> 4."""
    table, x = [], -2815
    for sixteenth in range(4096):
        while x < 2815 and SQUASH[x + 2815] < 16 * sixteenth + 8:
            x += 1
        table.append(x)
    return table


SQUASH = [squash(x) for x in range(-2815, 2816)]
STRETCH = stretch_table()


def saturate(x):
    """8.3.3: 16 bits."""
    return x if -32768 <= x <= 32767 else max(-32768, min(x, 32767))


class Mixer:
    """8.3.3: sets of weights, of which each decision takes one or more."""

    def __init__(self, first):
        """8.3.3: the weights of all sets are `first`."""
        self.first, self.sets = first, {}

    def select(self, chosen):
        """8.3.3: the weights of a set."""
        return self.sets.setdefault(chosen, self.first[:])

    def set_input(self, place, weight):
        """8.12.6: the weight of an input, in all sets."""
        for weights in [self.first, *self.sets.values()]:
            weights[place] = weight

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, first=self.first[:], sets={chosen: weights[:] for chosen, weights in self.sets.items()})


def probability(context):
    """8.3.5: q of a mixed context, which is a pair (n, k), and later q alone."""
    if isinstance(context, int):
        return context
    n, k = context
    return (4096 * (4 * k + 1) + 2 * n + 1) // (4 * n + 2)


def moved(context, bit):
    """8.3.5: a mixed context after a decision."""
    if isinstance(context, int):
        target = 4095 if bit else 0
        return context + ((target - context) * 3972 + (1 << 15) >> 16)
    after = context[0] + 1, context[1] + bit
    return after if after[0] < 15 else probability(after)


MIXED = [(n, k) for n in range(15) for k in range(n + 1)] + list(range(4096))
NEXT = {context: (moved(context, 0), moved(context, 1)) for context in MIXED}
INPUT = {context: 0 if probability(context) == 2048 else STRETCH[probability(context)] for context in MIXED}


def decide_mixed(decoder, contexts, weights, rate, more=(), behind=()):
    """8.3.3, 8.3.5: a decision in contexts, (table, index) each, and sets of weights; all adapt. more: inputs behind 256.

    behind: contexts whose inputs are the last (8.12.3).
    """
    inputs = [INPUT[table.contexts[i]] for table, i in contexts] + [256, *more]
    inputs += [INPUT[table.contexts[i]] for table, i in behind]
    summed = weights[0]
    for row in weights[1:]:
        summed = [saturate(a + b) for a, b in zip(summed, row)]
    p = SQUASH[min(max(sum(w * x for w, x in zip(summed, inputs)) >> 13, -2047), 2047) + 2815]
    bit = decoder.decide(p)
    error = ((bit << 16) - p) * rate >> 5
    steps = [x * error + (1 << 15) >> 16 for x in inputs]
    for row in weights:
        row[:len(steps)] = [saturate(w + step) for w, step in zip(row, steps)]
    for table, i in [*contexts, *behind]:
        table.contexts[i] = NEXT[table.contexts[i]][bit]
    return bit


class MixedContexts:
    """8.3.5: a table of mixed contexts."""

    def __init__(self, size):
        """8.3.5: the initial state."""
        self.contexts = [(0, 0)] * size

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, contexts=self.contexts[:])


class MixedDecision:
    """8.3.5: a decision in several contexts at a time."""

    def __init__(self, sizes):
        """8.3.5: the initial state."""
        self.tables = [MixedContexts(size) for size in sizes]
        n = len(sizes)
        self.mixer = Mixer([8500 // n] * n + [0] * (8 - n))

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, tables=copied_all(self.tables), mixer=self.mixer.copy())

    def decode(self, decoder, indices, chosen, behind=()):
        """8.3.5: a decision with the weights of set `chosen`; everything adapts. behind: 8.12.6."""
        return decide_mixed(decoder, list(zip(self.tables, indices)), [self.mixer.select(chosen)], 8, behind=behind)


def size_class(n, most):
    """8.3.6: cls(n, most)."""
    if n >= 4:
        width = n.bit_length()
        n = 4 * (width - 2) + (n >> width - 3 & 3)
    return min(n, most)


# ---- 8.4 Octree geometry

CHILDREN = [(c & 1, c >> 1 & 1, c >> 2) for c in range(8)]
DIRECTIONS = [(dx, dy, dz) for dz in (-1, 0, 1) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]


def window_bit(x, y, z):
    """8.4.1: a cell of the window as a bit, 0 outside it."""
    return 1 << (x + 4 * y + 16 * z) if 0 <= min(x, y, z) and max(x, y, z) < 4 else 0


def window_table():
    """8.4.1: the cells of the window that a neighbour in direction d with occupancy o has, as [d][o]."""
    table = []
    for dx, dy, dz in DIRECTIONS:
        cells = [window_bit(2 * dx + x + 1, 2 * dy + y + 1, 2 * dz + z + 1) for x, y, z in CHILDREN]
        table.append([sum(cells[c] for c in range(8) if o >> c & 1) for o in range(256)])
    return table


def around(distances):
    """8.4.2: the cells around (1, 1, 1) at these distances."""
    return sum(window_bit(dx + 1, dy + 1, dz + 1) for dx, dy, dz in DIRECTIONS
               if abs(dx) + abs(dy) + abs(dz) in distances)


def corner_directions(child):
    """8.4.2: the directions whose neighbours make up corner."""
    signs = [1 if side else -1 for side in child]
    patterns = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1))
    offsets = [[sign * used for sign, used in zip(signs, pattern)] for pattern in patterns]
    return [(dx + 1) + 3 * (dy + 1) + 9 * (dz + 1) for dx, dy, dz in offsets]


def columns_table(first, second):
    """8.4.3: which columns hold a child, by occupancy; first and second are the other axes."""
    return [sum({1 << CHILDREN[c][first] + 2 * CHILDREN[c][second] for c in range(8) if o >> c & 1})
            for o in range(256)]


WINDOW = window_table()
ALL = around((1, 2, 3))
CORNER = [corner_directions(child) for child in CHILDREN]
WINDOW_SHIFT = [x + 4 * y + 16 * z for x, y, z in CHILDREN]
COLUMNS_X, COLUMNS_Y, COLUMNS_Z = columns_table(1, 2), columns_table(0, 2), columns_table(0, 1)


HASH_A, HASH_B = 0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F


def hash_group(key, coded, bits, group_bits):
    """8.4.4: the first of a group of 2^group_bits contexts of 2^bits."""
    mask = (1 << 64) - 1
    h = (key + coded * HASH_B) & mask
    h = ((h ^ h >> 32) * HASH_A) & mask
    return h >> 64 - bits >> group_bits << group_bits


CELL_ROWS, NEIGHBOUR_ROWS, HASHED_ROWS = 64, 27 * 256, 1 << 14      # of table 8-5
REFERENCE_ROWS = CELL_ROWS + NEIGHBOUR_ROWS + HASHED_ROWS           # the first of 64 + 256 of 8.12.3
OWN_CELL = window_bit(1, 1, 1)
LOWER, UPPER = (12, 10, 4), (14, 16, 22)    # directions along x, y, z


def bits_of(bits):
    """8.4.7: the numbers of the bits that are set, ascending."""
    return [i for i in range(bits.bit_length()) if bits >> i & 1]


def hashed_row(kind, value):
    """8.4.7: the row of a value of a kind."""
    h = (kind * 2**27 + value) * HASH_A % 2**64
    return CELL_ROWS + NEIGHBOUR_ROWS + (h >> 50)


class Rows:
    """8.4.7: a table of rows."""

    def __init__(self):
        """8.4.7: the initial state: eight lanes of 0, with 12 fractional bits."""
        self.values = np.zeros((REFERENCE_ROWS + 64 + 256, 8), np.int32)

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, values=self.values.copy())

    def logistic(self, selected):
        """8.4.7: what the rows of a node say of each decision."""
        rows = self.values[selected]
        sums = rows.cumsum(axis=0)
        total = sums[-1].tolist()
        for lane in np.flatnonzero(abs(sums).max(axis=0) > 32767):
            total[lane] = 0
            for value in rows[:, lane].tolist():
                total[lane] = saturate(total[lane] + value)
        return [x >> 4 for x in total]

    def learn(self, selected, slow, logistic, decided, rate):
        """8.4.7: all rows of a node move, the first `slow` of them by less; decided: bits by lane, None where there was none."""
        errors = [0 if bit is None else (bit << 16) - SQUASH[x + 2815] >> 1 for bit, x in zip(decided, logistic)]
        steps = np.empty((len(selected), 8), np.int32)
        steps[:slow] = [error * 32 * rate + (1 << 15) >> 16 for error in errors]
        steps[slow:] = [error * 128 * rate + (1 << 15) >> 16 for error in errors]
        np.add.at(self.values, selected, steps)             # a row may be there twice
        self.values[selected] = np.clip(self.values[selected], -32768, 32767)


class OctreeState:
    """8.1: what geometry units hand on."""

    def __init__(self, points):
        """8.4.2: contexts of table 8-3, three mixers, by the points of all slices; rows."""
        self.hash_bits = min(18, max(points.bit_length() + 4, 10))
        widths = (15, self.hash_bits, self.hash_bits)
        self.tables = [MixedContexts(1 << bits) for bits in widths]
        self.by_slabs = MixedContexts(64 * 256)             # 8.4.8
        self.mixers = [Mixer([900] * 8) for _ in range(3)]
        self.only_tables = [MixedContexts(size) for size in (8000, 8000, 1 << self.hash_bits)]      # 8.4.6
        self.only_mixers = [Mixer([900] * 8) for _ in range(2)] + [Mixer([0] * 8)]       # the third: 8.4.8
        self.rows, self.only_rows = Rows(), Rows()
        self.nodes_coded, self.reference_tables = 0, []

    def add_reference(self):
        """8.12.5: what is new in the first predicted frame: contexts of table 8-6, a fourth mixer."""
        if not self.reference_tables:
            widths = 2 * 17 * 14 * 5 * 3, 1 << 16, 1 << self.hash_bits
            self.reference_tables = [MixedContexts(size) for size in widths]
            self.mixers.append(Mixer([900] * 8))

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, tables=copied_all(self.tables), by_slabs=self.by_slabs.copy(), mixers=copied_all(self.mixers),
                      only_tables=copied_all(self.only_tables), only_mixers=copied_all(self.only_mixers),
                      rows=self.rows.copy(), only_rows=self.only_rows.copy(),
                      reference_tables=copied_all(self.reference_tables))


def lone(occupancy):
    """8.4.6: which child it is, 8 where there is none, 9 where there are several."""
    if not occupancy:
        return 8
    return occupancy.bit_length() - 1 if occupancy & occupancy - 1 == 0 else 9


class Slabs:
    """8.4.8: what the nodes of a level that share a coordinate have in common."""

    SLOTS = 4096

    def __init__(self):
        """8.4.8: new at the start of every level."""
        self.sparse = True
        self.only = [MixedContexts(self.SLOTS) for _ in range(3)]
        self.halves = [MixedContexts(self.SLOTS) for _ in range(3)]

    def of_node(self, node):
        """8.4.8: the context of each axis for the only child of a node."""
        return [(table, x % self.SLOTS) for table, x in zip(self.only, node)]

    def of_children(self, node):
        """8.4.8: the number t of each child."""
        def says(axis, half):
            context = self.halves[axis].contexts[(2 * node[axis] + half) % self.SLOTS]
            return min(max(INPUT[context] + 1024 >> 9, 0), 3)

        return [sum(says(axis, child[axis]) << 2 * axis for axis in range(3)) for child in CHILDREN]

    def learn(self, node, coded):
        """8.4.8: which halves of a node hold a child."""
        for axis in range(3):
            for half in range(2):
                there = any(coded >> c & 1 and child[axis] == half for c, child in enumerate(CHILDREN))
                contexts, i = self.halves[axis].contexts, (2 * node[axis] + half) % self.SLOTS
                contexts[i] = NEXT[contexts[i]][there]


class Octree:
    """8.4: the geometry of a part."""

    def __init__(self, nodes, level, most):
        """8.2, 8.4.1: what it begins with, and how many nodes a level may have."""
        self.nodes, self.level, self.most, self.state = nodes, level, most, None
        self.moved = None                   # 8.12: the reference of a predicted frame

    def decode_level(self, decoder):
        """8.4.1: the children of all nodes of a level."""
        adjacent = self.all_neighbours()
        occupancies = [0] * len(self.nodes)                 # 0: not coded yet
        history, slabs = [{} for _ in range(3)], Slabs()
        slabs.sparse = sum(map(len, adjacent)) < 12 * len(self.nodes)
        following, state = [], self.state
        only = decoder.raw(1)
        for i, (x, y, z) in enumerate(self.nodes):
            neighbours = occupied = unknown = 0
            for d, j in adjacent[i].items():
                neighbours |= 1 << d
                if occupancies[j]:
                    occupied |= WINDOW[d][occupancies[j]]
                else:
                    unknown |= WINDOW[d][255]
            entries = self.history_entries(x, y, z)
            around_node, node = (neighbours, occupied, unknown), ((x, y, z), slabs)
            latest = [table.get(k, 0) for table, k in zip(history, entries)]
            beside = [occupancies[adjacent[i][d]] if d in adjacent[i] else 0 for d in LOWER]
            known = {d: occupancies[j] or 256 for d, j in adjacent[i].items()}
            further = [sum(1 << d for d in adjacent[adjacent[i][u]]) if u in adjacent[i] else 0 for u in UPPER]
            there = self.moved.there((x, y, z), self.level, occupied, unknown) if self.moved else None
            rows = self.select_rows((x, y, z), around_node, known, further, there)
            rate = 8 - min(state.nodes_coded >> 13, 4)
            coded = self.decode_only(decoder, node, around_node, latest, beside, rows, rate) if only else 0
            coded = coded or self.decode_node(decoder, node, around_node, self.columns(latest), rows, rate, there)
            state.nodes_coded += 1
            for table, entry in zip(history, entries):
                table[entry] = coded
            occupancies[i] = coded
            following += [(2 * x + cx, 2 * y + cy, 2 * z + cz)
                          for c, (cx, cy, cz) in enumerate(CHILDREN) if coded >> c & 1]
            require(len(following) <= self.most, "gu_occupancy")
        self.nodes = following
        self.level += 1

    def all_neighbours(self):
        """8.4.1: the nodes in the directions around every node, by direction."""
        index, adjacent = {node: i for i, node in enumerate(self.nodes)}, []
        for i, (x, y, z) in enumerate(self.nodes):
            beside = [index.get((x + dx, y + dy, z + dz), i) for dx, dy, dz in DIRECTIONS]
            adjacent.append({d: j for d, j in enumerate(beside) if j != i})
        return adjacent

    def select_rows(self, node, around_node, known, further, there=None):
        """8.4.7, 8.12.3: the rows of a node by table 8-5, and how many of them are slow."""
        neighbours, occupied, _ = around_node
        rows = bits_of(occupied | OWN_CELL)
        rows += [CELL_ROWS + 256 * d for d in known if known[d] == 256]
        if there:
            rows += [REFERENCE_ROWS + i for i in bits_of(there.cells)]
        rows += [hashed_row(axis, node[axis]) for axis in range(3)]
        slow = len(rows)
        if there:
            rows.append(REFERENCE_ROWS + 64 + there.family)
        rows += [CELL_ROWS + 256 * d + known[d] for d in known if known[d] < 256]
        lower, upper = [[known.get(d, 0) for d in directions] for directions in (LOWER, UPPER)]
        for axis in range(3):
            rows.append(hashed_row(3 + axis, 512 * lower[axis] + upper[axis]))
            rows.append(hashed_row(6 + axis, 512 * lower[axis] + lower[(axis + 1) % 3]))
            if upper[axis]:
                rows.append(hashed_row(9 + axis, further[axis]))
        rows.append(hashed_row(12, neighbours))
        return rows, slow

    def decode_node(self, decoder, node, around_node, columns, rows, rate, there=None):
        """8.4.1: eight decisions, the last of which may be implied."""
        coded, state, (place, slabs) = 0, self.state, node
        by_rows = state.rows.logistic(rows[0])
        by_slabs = slabs.of_children(place)
        for c in range(8):
            if c == 7 and coded == 0:
                coded = 128
                break
            if abs(by_rows[c]) >= 1152:                     # certain
                coded |= decoder.decide(SQUASH[min(max(by_rows[c], -2047), 2047) + 2815]) << c
                continue
            indices, sets = self.predict(c, coded, around_node, columns, by_rows[c])
            behind = [(state.by_slabs, by_slabs[c] * 256 + (1 << c | coded))] if slabs.sparse else []
            if there:
                more, chosen = there.predict(c, coded, state.hash_bits)
                behind, sets = list(zip(state.reference_tables, more)), (*sets, chosen)
            weights = [mixer.select(k) for mixer, k in zip(state.mixers, sets)]
            coded |= decide_mixed(decoder, list(zip(state.tables, indices)), weights, rate, [by_rows[c]], behind) << c
        state.rows.learn(*rows, by_rows, [coded >> c & 1 for c in range(8)], rate)
        if slabs.sparse and not there:
            slabs.learn(place, coded)
        return coded

    def decode_only(self, decoder, node, around_node, latest, beside, rows, rate):
        """8.4.6: the occupancy of a node of one child, 0 of another."""
        state, place, decided = self.state, 1, [None] * 8
        tables = state.only_tables + state.tables[1:]
        first, sets = self.predict_only(around_node, latest, beside)
        by_rows = state.only_rows.logistic(rows[0])
        by_slab = node[1].of_node(node[0])

        def decide(p):
            axis = 3 - p.bit_length() if p else 3           # 3: none
            slab = [by_slab[axis]] if p else []
            x = INPUT[slab[0][0].contexts[slab[0][1]]] if p else 0
            chosen = *sets(p), 16 * axis + min(max(x + 2048 >> 8, 0), 15)
            weights = [mixer.select(k) for mixer, k in zip(state.only_mixers, chosen)]
            contexts = [(table, i + p) for table, i in zip(tables, first)]
            decided[p] = decide_mixed(decoder, contexts, weights, rate, [by_rows[p]], slab)
            return decided[p]

        if decide(0):
            for _ in range(3):
                place = 2 * place + decide(place)
        state.only_rows.learn(*rows, by_rows, decided, rate)
        return 1 << place - 8 if decided[0] else 0

    def predict_only(self, around_node, latest, beside):
        """8.4.6: the indices of table 8-4 but for p, and the sets of weights by p."""
        neighbours, occupied, unknown = around_node
        bits, nN = self.state.hash_bits, neighbours.bit_count()
        first = [((10 * lone(of[2]) + lone(of[1])) * 10 + lone(of[0])) * 8 for of in (beside, latest)]
        for key in (neighbours * HASH_A, self.columns(latest) * HASH_A, occupied * HASH_A + unknown * HASH_B):
            first.append(hash_group(key, 256, bits, 3))
        return first, lambda p: (8 * p + min(nN // 3, 7), 22 * p + self.level)

    def predict(self, c, coded, around_node, columns, by_rows):
        """8.4.2: the indices of table 8-3 and the sets of weights."""
        neighbours, occupied, unknown = around_node
        bits = self.state.hash_bits
        siblings = 1 << c | coded
        O = occupied >> WINDOW_SHIFT[c] & ALL
        U = unknown >> WINDOW_SHIFT[c] & ALL
        corner = 0
        for k, d in enumerate(CORNER[c]):
            corner |= (neighbours >> d & 1) << k
        nO, nN = O.bit_count() + coded.bit_count(), neighbours.bit_count()
        first_half = c < 4
        node_key = 0 if first_half else 8 | coded & 7
        node_bits = 4 if first_half else 5
        in_node = siblings if first_half else (coded >> 3 & 1) * 16 + (1 << c - 4 | coded >> 4)
        older = max(c - 3, 0)
        indices = (
            siblings * 128 + corner,
            hash_group(columns * HASH_A, node_key, bits, node_bits) + in_node,
            hash_group(O * HASH_A + (U * 8 + c) * HASH_B, coded & (1 << older) - 1, bits, 3) + (coded >> older))
        return indices, (siblings * 8 + min(nN // 3, 7), nO * 22 + self.level, min(max(by_rows + 1024 >> 7, 0), 15))

    def history_entries(self, x, y, z):
        """8.4.3: a node's entries in the three tables: (y, z), (x, z), (x, y)."""
        entries = []
        for a, b in ((y, z), (x, z), (x, y)):
            if 2 * self.level <= 18:
                entries.append(a + (b << self.level))
            else:
                entries.append((a * 2654435761 ^ b * 2246822519) % (1 << 32) >> 14)
        return entries

    @staticmethod
    def columns(latest):
        """8.4.3: columns of a node."""
        by_yz, by_xz, by_xy = latest
        return 4096 + COLUMNS_X[by_yz] * 256 + COLUMNS_Y[by_xz] * 16 + COLUMNS_Z[by_xy]


FACES = [4, 10, 12, 14, 16, 22]             # directions of 8.4.1; the first three come before


def decode_classes(decoder, cells):
    """8.4.5: the classes of base cells."""
    more = MixedDecision([4 * 67 * 22, 64 * 22, 256 * 22])
    families = {}
    for x, y, z in cells:
        parent = x >> 1, y >> 1, z >> 1
        families[parent] = families.get(parent, 0) | 1 << (x & 1) + 2 * (y & 1) + 4 * (z & 1)
    occupied, classes = set(cells), {}
    for x, y, z in cells:
        places = [(x + dx, y + dy, z + dz) for dx, dy, dz in (DIRECTIONS[d] for d in FACES)]
        beside = [classes[place] for place in places[:3] if place in classes]
        contexts = [67 * len(beside) + sum(beside), sum((place in occupied) << i for i, place in enumerate(places)),
                    families[x >> 1, y >> 1, z >> 1]]
        k = 0
        while k < 22 and more.decode(decoder, [22 * context + k for context in contexts], k):
            k += 1
        classes[x, y, z] = k
    require(sum(1 << k for k in classes.values()) <= 1 << 24, "gu_weight_class")
    return list(classes.values())


# ---- 8.6 The transform tree

class TransformTree:
    """8.6: the merges of a part."""

    def __init__(self, codes, weights):
        """8.6.1: split, left, end and parent of every row; 8.6.3: coding order."""
        count = len(codes)
        self.codes, self.before = codes, [0, *itertools.accumulate(weights)]
        self.split = [3 * 21] + [(codes[r] ^ codes[r - 1]).bit_length() - 1 for r in range(1, count)]
        self.left = [0] * count
        self.end = [count] * count
        stack = [0]
        for r in range(1, count):
            while self.split[stack[-1]] < self.split[r]:
                self.end[stack.pop()] = r
            self.left[r] = stack[-1]
            stack.append(r)
        # the node joined by the merge of row r is joined next at its own first row or at the row after it
        self.parent = [0] * count
        for r in range(1, count):
            left, end = self.left[r], self.end[r]
            if end == count or (left and self.split[left] < self.split[end]):
                self.parent[r] = left
            else:
                self.parent[r] = end
        self.order = [0] + sorted(range(1, count), key=lambda r: (-self.split[r], r))
        self.row_of_cell = {(self.split[r], codes[r] >> self.split[r] + 1): r for r in range(1, count)}
        self.scale = [256] + [self.scale_of(r) for r in range(1, count)]

    def joined(self, r):
        """8.6.2: wl and wr of the merge of row r."""
        at, before = self.before[r], self.before
        return at - before[self.left[r]], before[self.end[r]] - at

    def scale_of(self, r):
        """8.7.2: the scale of the merge of row r."""
        left, right = self.joined(r)
        return math.isqrt(left * right * 2**16 // (left + right))

    def faces(self, r):
        """8.7.2: the rows of the same split beside row r towards lower x, y, z, 0 where there is none."""
        split, rows = self.split[r], []
        cell = self.codes[r] >> split + 1 << split + 1
        for axis in range(3):
            along = sum(1 << bit for bit in range(axis, 63, 3) if bit > split)
            beside = (cell & along) - 1 & along | cell & ~along
            rows.append(self.row_of_cell.get((split, beside >> split + 1), 0) if cell & along else 0)
        return rows

    def rotation(self, r):
        """8.6.2: c and s of the merge of row r."""
        left, right = self.joined(r)
        cosine, sine = [math.isqrt(weight * 2**40 // (left + right) * 2**20) for weight in (left, right)]
        return cosine, sine

    def rows(self, begin, end, grid_bits):
        """8.6.3: rows of the levels begin .. end - 1, in coding order; row 0 is one of the first range."""
        return [r for r in self.order
                if (begin == 0 if r == 0 else begin <= grid_bits - 1 - self.split[r] // 3 < end)]

    def nodes(self, bits):
        """8.6.4, 8.9.3: the first rows of the nodes whose codes agree above `bits` bits."""
        return [r for r in range(len(self.codes)) if r == 0 or self.split[r] >= bits]


def round_off(x, bits):
    """8.6.2: division by 2^bits, to nearest, ties away from zero."""
    return x + (1 << bits - 1) - (x < 0) >> bits


def round30(x):
    """8.6.2: round30."""
    return round_off(x, 30)


def cell_values(base_values, points, weights):
    """8.6.4: the values of cell rows, [cells, planes], of those of the base, their points and weights there."""
    roots = np.array([math.isqrt((w << 40) // weight) for w, weight in zip(points, weights)], np.int64)
    return np.clip(round_off(base_values * roots[:, None], 20), -2**29, 2**29)


# ---- 8.7 Coefficients

BY_REFERENCE, EMPTY, MOVED = 1, 2, 3        # the features of 8.12.6, 7.13 and 8.12.7
SHARES = [2, 2, 1, 3, 3, 3, 1]              # of the rows around, 8.7.2


class VectorState:
    """8.1: what coefficient units of a group hand on, of the vector coder."""

    def __init__(self, functions):
        """8.7.2: contexts and activities."""
        self.node = MixedDecision([48 * 16, 5**4 * 3, 5**3 * 3 * 4])
        self.more = MixedDecision([n * 48 for n in (20 * 64, 24 * 24, 16 * 16)])
        self.rest = MixedDecision([32 * 48, 24 * 5 * 12, 32 * 5 * 16])
        self.any = MixedDecision([20 * 20, 56 * 24, 48 * 24])
        self.negative = MixedDecision([3**5, 3**5, 3**6, 5**3 * 27])
        self.prefix = [Contexts(28) for _ in range(12)]
        self.activity = [16 if functions > 1 else 0] * (3 * functions)
        self.by_reference = []

    def add_reference(self):
        """8.12.6: what is new in the first predicted frame: a table more of two decisions."""
        if not self.by_reference:
            self.by_reference = [MixedContexts(26 * 3 * 12), MixedContexts(13 * 3 * 12 * 48)]
            for decision in (self.node, self.more):
                decision.mixer.set_input(4, 2125)

    def copy(self):
        """8.1: as that of Contexts."""
        decisions = {name: getattr(self, name).copy() for name in ("node", "more", "rest", "any", "negative")}
        return copied(self, prefix=copied_all(self.prefix), activity=self.activity[:],
                      by_reference=copied_all(self.by_reference), **decisions)


class VectorCoder:
    """8.7.2: the vector coder of one group of a part; 8.7.7: of one of its layers."""

    new_state = VectorState

    def __init__(self, functions, tree, group_before, coarser=None):
        """8.7.2: vectors kept for contexts; coarser is the layer before, if any."""
        self.coarser = coarser
        self.planes, self.tree, self.group_before, self.state = 3 * functions, tree, group_before, None
        self.sums = [0] * len(tree.split)
        self.runs = [0] * len(tree.split)
        self.quantised = {}                 # of rows that are not all zero
        self.kept = {0: [0] * self.planes}  # the same without row 0, within -4095 .. 4095
        self.there = None                   # 8.12.6: h and p of rows

    def adopt(self, base, row, cell):
        """8.7.2: a cell row has the kept vector of its base cell."""
        self.kept[row] = base.kept.get(cell, base.kept[0])
        self.sums[row], self.runs[row] = base.sums[cell], base.runs[cell]

    def decode(self, decoder, rows):
        """8.7.2: rows in coding order; a row whose node decision is 0 has no coefficients."""
        last = 0
        if self.there:
            self.state.add_reference()
        for r in rows:
            self.row_there = self.there(r) if self.there else None
            split = min(self.tree.split[r], 44) if r else 44
            above, beside, same_axis = self.around(r, last)
            last = r
            self.weigh(r, above, beside)
            self.axis = self.tree.split[r] % 3 if r else 2
            known = self.coarser.quantised.get(r) if self.coarser else None
            if known or self.decode_node(decoder, r, split):
                self.decode_row(decoder, r, same_axis, known or [0] * self.planes)

    def double(self, rows):
        """8.7.7: a refinement whose codeword is empty."""
        for r in rows:
            if r in self.coarser.quantised:
                require(max(map(abs, self.coarser.quantised[r])) < 1 << 26, "cu_magnitude")
                self.quantised[r] = [2 * v for v in self.coarser.quantised[r]]

    def around(self, r, last):
        """8.7.2: A0 - A2, A3 - A6, and the nearest of the first three that has the same axis."""
        if r == 0:
            return [0] * 3, [0] * 4, 0
        tree = self.tree
        above = [tree.parent[r]]
        above += [tree.parent[above[0]], tree.parent[tree.parent[above[0]]]]
        aligned = [row for row in above if row and (tree.split[row] - tree.split[r]) % 3 == 0]
        previous = last if last and tree.split[last] == tree.split[r] else 0
        return above, tree.faces(r) + [previous], aligned[0] if aligned else 0

    def weigh(self, r, above, beside):
        """8.7.2: w_k; the rows that are there; whether there is one beside."""
        self.rows = above + beside
        self.any_beside = any(beside)
        shares_beside = sum(share for share, row in zip(SHARES[3:], beside) if row)
        self.weights = []
        for k, row in enumerate(self.rows):
            weight = 0
            if self.sums[row]:
                divisor = self.tree.scale[row] * (5 if k < 3 else shares_beside)
                weight = min(SHARES[k] * self.tree.scale[r] * 256 // divisor, 32767)
            self.weights.append(weight)
        self.scale_class = size_class(self.tree.scale[r] >> 5, 23)

    def expected(self, magnitudes):
        """8.7.2: `up` and `side` for the magnitudes of the seven rows."""
        products = [w * m for w, m in zip(self.weights, magnitudes)]
        up = sum(products[:3])
        return up, sum(products[3:]) if self.any_beside else up

    def decode_node(self, decoder, r, split):
        """8.7.2, 1: is the vector not all zero?"""
        sums = [self.sums[row] for row in self.rows]
        z = [size_class(n, 4) for n in sums]
        below = size_class(self.group_before.sums[r], 15) if self.group_before else 0
        size, behind = size_class(sum(self.expected([min(n, 4095) for n in sums])) // 2 >> 4, 47), []
        if self.row_there:                  # 8.12.6
            h, p = self.row_there
            total = 25 if h is None else size_class(sum(h), 24)
            behind = [(self.state.by_reference[0], (3 * total + p) * 12 + size // 4)]
        return self.state.node.decode(decoder, [
            size * 16 + below,
            (((z[0] * 5 + z[1]) * 5 + z[2]) * 5 + z[6]) * 3 + self.axis,
            (((z[3] * 5 + z[4]) * 5 + z[5]) * 3 + self.axis) * 4 + min(below, 3)], split, behind)

    def decode_row(self, decoder, r, same_axis, known):
        """8.7.2, 2: the values of a row; 8.7.7: what is known of them."""
        known_end = max((j // 3 + 1 for j, v in enumerate(known) if v), default=0)
        values, kept = [0] * self.planes, [0] * self.planes
        around = [self.kept.get(row, self.kept[0]) for row in self.rows + [same_axis]]
        means = [self.expected([abs(row[j]) for row in around[:7]]) for j in range(self.planes)]
        ahead = [min((up + side) // 2 + (a >> 5), 1 << 18) for (up, side), a in zip(means, self.state.activity)]
        functions, total, activity_total, recent, last = self.planes // 3, 0, 0, 0, 0
        for f in range(functions):
            planes = range(3 * f, 3 * f + 3)
            if f % 4 == 0:
                run_before, recent = recent, 0
            if f and f % 4 == 0 and total and f >= known_end:
                if not self.decode_rest(decoder, f, sum(ahead[3 * f:]), total, run_before):
                    for j in range(3 * f, self.planes):
                        self.state.activity[j] += -self.state.activity[j] >> 6
                    break
            before = self.functions_before(kept, f)
            if functions > 1 and (total or f < functions - 1) and not any(known[j] for j in planes):
                evidence = [sum(part) for part in zip(*[means[j] for j in planes])]
                activity = sum(self.state.activity[j] for j in planes)
                if not self.decode_any(decoder, before, evidence, activity, total, activity_total):
                    activity_total += activity
                    for j in planes:
                        self.state.activity[j] += -self.state.activity[j] >> 6
                    continue
            recent, last, expected = recent + 1, f, []
            for j in planes:
                activity = self.state.activity[j]
                up, side = means[j]
                expected.append((up + side) // 2 + (activity >> 5))
                ratio = size_class((total * 64 + 16) * activity // (activity_total + 256), 47)
                contexts = self.magnitude_contexts(kept, j, expected, ratio)
                magnitude = self.decode_magnitude(decoder, contexts, j, expected[-1], total, kept, known[j])
                if magnitude:
                    negative = known[j] < 0 if known[j] else self.decode_sign(decoder, kept, j, around)
                    values[j] = -magnitude if negative else magnitude
                    kept[j] = min(max(values[j], -4095), 4095)
                total += abs(kept[j])
                activity_total += activity
                if self.planes > 3:
                    self.state.activity[j] += (min(magnitude, 7) * 4096 - activity) >> 6
        self.quantised[r] = values
        if r:
            self.kept[r], self.sums[r], self.runs[r] = kept, min(total, 65535), min(last // 4 + 1, 255)

    @staticmethod
    def functions_before(kept, f):
        """8.7.2, 2: `before`."""
        if f == 0:
            return 16
        return min(abs(kept[3 * f - 3]), 3) + 4 * (min(abs(kept[3 * f - 6]), 2) if f > 1 else 3)

    def decode_rest(self, decoder, f, expected, total, recent):
        """8.7.2, 3: has the vector a value from function f on?"""
        run, size = min(f // 4, 31), size_class(expected >> 4, 47)
        h = [min(max(self.runs[row] - run, 0), 3) for row in (self.rows[0], self.rows[6])]
        return self.state.rest.decode(decoder, [
            run * 48 + size,
            (size_class(total, 23) * 5 + recent) * 12 + size // 4,
            (run * 5 + recent) * 16 + h[0] * 4 + h[1]], run)

    def decode_any(self, decoder, before, evidence, activity, total, activity_total):
        """8.7.2, 4: has the function a value?"""
        up, side = evidence
        size = size_class((up + side) // 2 + (activity >> 5) >> 4, 47)
        ratio = size_class((total * 64 + 16) * activity // (activity_total + 256), 55)
        act = size_class(activity >> 2, 47)
        return self.state.any.decode(decoder, [
            size_class(up >> 4, 39) // 2 * 20 + size_class(side >> 4, 39) // 2,
            ratio * 24 + size // 2,
            act * 24 + self.scale_class], before + (0 if total else 17))

    def magnitude_contexts(self, kept, j, expected, ratio):
        """8.7.2, 5: the contexts of a magnitude."""
        channel = j % 3
        earlier = [abs(v) for v in kept[j - channel:j]]
        by_channel = [size_class((2 * m + 1) * 8 * (expected[channel] + 16) // (e + 16), 47)
                      for m, e in zip(earlier, expected)]
        channels = 0
        if channel == 0:
            other = self.functions_before(kept, j // 3)
        elif channel == 1:
            other, channels = size_class(earlier[0], 15), by_channel[0]
        else:
            other = min(earlier[1], 3) * 16 + size_class(earlier[0], 15)
            channels = by_channel[1] // 2 * 24 + by_channel[0] // 2
        level = size_class(expected[channel] >> 4, 47)
        contexts = [min(level // 2, 19) * 64 + other, channels, ratio // 3 * 16 + level // 3]
        return [(context * 3 + channel) * 16 for context in contexts]

    def decode_magnitude(self, decoder, contexts, j, expected, total, kept, known):
        """8.7.2, 5: a magnitude; 8.7.7: its last bit."""
        chosen = (j % 3 if total else 3 + j % 3) * 16
        implied = j % 3 == 2 and not kept[j - 1] and not kept[j - 2]
        if self.coarser:
            least = 2 * abs(known)
            require(least < 1 << 27, "cu_magnitude")
            if implied and not least:
                return 1
            i = min(least, 14)
            return least + self.state.more.decode(decoder, [c + i for c in contexts], chosen + i)
        for magnitude in range(1 if implied else 0, 15):
            behind = self.magnitude_there(j, expected, magnitude)
            if not self.state.more.decode(decoder, [c + magnitude for c in contexts], chosen + magnitude, behind):
                return magnitude
        prefix = self.state.prefix[min(size_class(expected >> 8, 47) // 4, 11)]
        return 14 + decoder.exp_golomb(prefix, 255, "cu_magnitude")

    def magnitude_there(self, j, expected, i):
        """8.12.6: the context of a magnitude by the reference, if any."""
        if not self.row_there:
            return []
        h, p = self.row_there
        z = 12 if h is None else size_class(h[j], 23) // 2
        return [(self.state.by_reference[1], (((3 * z + p) * 12 + size_class(expected >> 4, 47) // 4) * 3 + j % 3) * 16 + i)]

    def decode_sign(self, decoder, kept, j, around):
        """8.7.2, 6: is the value negative?"""
        channel, first = j % 3, j - j % 3
        parent, grandparent, _, *faces, previous, same_axis = around

        def sign(v):
            return 1 if v > 0 else 2 if v < 0 else 0

        def strong(v):
            return sign(v) + (2 if abs(v) > 1 else 0)

        def product(row, earlier):
            a, b = row[first + earlier], row[j]
            return (1 if a * b > 0 else 2) if earlier < channel and a and b else 0
        own = [sign(kept[first + c]) if c < channel else 0 for c in range(2)]
        place = self.axis * 3 + channel
        f = [sign(row[j]) for row in faces]
        return self.state.negative.decode(decoder, [
            ((own[0] * 3 + product(parent, 0)) * 3 + product(grandparent, 0)) * 9 +
            product(previous, 0) * 3 + channel,
            ((f[0] * 3 + f[1]) * 3 + f[2]) * 9 + place,
            (((own[0] * 3 + own[1]) * 3 + product(parent, 0)) * 3 + product(parent, 1)) * 9 +
            product(previous, 1) * 3 + channel,
            (((strong(same_axis[j]) * 5 + strong(parent[j])) * 5 + strong(previous[j])) * 3 + own[0]) * 9 +
            place], channel * 3 + own[0])


class IndependentState:
    """8.1: what coefficient units of a group hand on, of the independent coder."""

    def __init__(self, functions):
        """8.7.3: contexts."""
        self.nonzero = Contexts(3 * functions)
        self.magnitudes = [MagnitudeContexts() for _ in range(3 * functions)]

    def copy(self):
        """8.1: as that of Contexts."""
        return copied(self, nonzero=self.nonzero.copy(), magnitudes=copied_all(self.magnitudes))


class IndependentCoder:
    """8.7.3: the independent coder of one group of a part."""

    new_state = IndependentState

    def __init__(self, functions, _tree, _group_before):
        """8.7.3: nothing but quantised coefficients."""
        self.quantised, self.state = {}, None

    def adopt(self, base, row, cell):
        """8.7.2: no vectors are kept."""

    def decode(self, decoder, rows):
        """8.7.3: rows in coding order, planes ascending."""
        for r in rows:
            values = [0] * len(self.state.magnitudes)
            for j, contexts in enumerate(self.state.magnitudes):
                if decoder.adaptive(self.state.nonzero, j, 30):
                    magnitude = decoder.magnitude(contexts, 30, "cu_magnitude")
                    values[j] = -magnitude if decoder.raw(1) else magnitude
            self.quantised[r] = values


def reconstruct(sequence, coders, points, coded):
    """8.7.4: coefficients by row and plane, of the last layer of each; those of groups without a coder are 0 (8.9)."""
    coefficients = np.zeros((points, 3 * len(coded)), np.int64)
    for functions, layers, number in zip(sequence.coded, coders, sequence.layers):
        planes = [(3 * coded.index(k) + c, sequence.steps[k][c]) for k in functions for c in range(3)]
        last = {r: (layer, values) for layer, coder in enumerate(layers) for r, values in coder.quantised.items()}
        for r, (layer, values) in last.items():
            missing = number - 1 - layer
            for (plane, step), value in zip(planes, values):
                coefficients[r, plane] = dequantised(value, step, missing)
    return coefficients


def dequantised(value, step, missing):
    """8.7.4: a coefficient, of whose layers some are missing."""
    whole = (abs(value) << missing) * step
    require(whole < 1 << 27, "cu_magnitude")
    magnitude = min(whole + 3 * ((1 << missing) - 1) * step // 8, (1 << 27) - 1) if value else 0
    return -magnitude if value < 0 else magnitude


class Prediction:
    """8.7.6: the corrections of the children of a level, for planes of one mode."""

    def __init__(self, tree, grid_bits, level, mode, there=None):
        """8.7.6: the nodes of the level and of the one below, by their cells; there: 8.12.4, of the planes."""
        self.codes, self.before, self.mode = tree.codes, tree.before, mode
        self.there, self.all_there = None, mode == 4
        if mode >= 4:
            self.mode, self.there = 3 if mode == 4 else mode - 4, there
        self.side = 1 << (grid_bits - 1 - level)
        self.sums = [(0, 0, 0)]             # of the positions before a row
        for code in self.codes:
            self.sums.append(tuple(s + v for s, v in zip(self.sums[-1], from_morton(code))))
        self.nodes, self.children = [self.cells(3 * (grid_bits - below)) for below in (level, level + 1)]
        self.order = {cell: i for i, cell in enumerate(self.nodes)}

    def cells(self, bits):
        """8.7.6: first row and end of every node, by cell, in Morton order."""
        cell = [code >> bits for code in self.codes]
        first = [r for r in range(len(cell)) if r == 0 or cell[r] != cell[r - 1]]
        return {from_morton(cell[r]): (r, end) for r, end in zip(first, first[1:] + [len(cell)])}

    def closeness(self, *nodes):
        """8.7.6: q of two nodes."""
        centres = [[16 * (after - before) // ((end - r) * self.side)
                    for before, after in zip(self.sums[r], self.sums[end])] for r, end in nodes]
        square = 51 + sum((x - y) ** 2 for x, y in zip(*centres))
        return (1 << 24) // square if self.mode == 1 else (1 << 30) // square ** 2

    def weight(self, node):
        """8.6.2: the weight of a node."""
        return self.before[node[1]] - self.before[node[0]]

    def mean(self, values, node):
        """8.7.6: the mean of a node."""
        value = round30(values[node[0]] * math.isqrt(2**60 // self.weight(node)))
        return np.clip(value, 1 - 2**17, 2**17 - 1)

    def difference(self, cell, child, values, before):
        """8.7.6: d of a child."""
        node, here, terms = self.nodes[cell], self.children[child], []
        for mask in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1)):
            step = [(2 * (x & 1) - 1) * m for x, m in zip(child, mask)]
            beside = tuple(x + s for x, s in zip(child, step))
            other = tuple(x + s for x, s in zip(cell, step))
            if other not in self.nodes:
                continue
            if self.order[other] < self.order[cell] and beside in self.children:
                terms.append((self.closeness(here, self.children[beside]), self.mean(values, self.children[beside])))
            else:
                terms.append((self.closeness(here, self.nodes[other]), self.mean(before, self.nodes[other])))
        total = self.closeness(here, node) + sum(q for q, _ in terms)
        own = self.mean(before, node)
        if self.there and (from_there := self.there(child)):            # 8.12.4
            weighted = [] if self.all_there else [(4096 * q // total // 2, term) for q, term in terms]
            weighted += [(w if self.all_there else w // 2, term) for w, term in from_there]
            return sum([w * (term - own) for w, term in weighted], 0 * own) >> 6
        return sum([4096 * q // total * (term - own) for q, term in terms], 0 * own) >> 6

    def correct(self, values, before):
        """8.7.6: corrects the children, branching nodes in Morton order; before holds the values of the level."""
        for cell in self.nodes:
            children = [tuple(2 * x + c for x, c in zip(cell, child)) for child in CHILDREN]
            children = [child for child in children if child in self.children]
            if len(children) < 2:
                continue
            d = [self.difference(cell, child, values, before) for child in children]
            rows = [self.children[child] for child in children]
            weights = [self.weight(row) for row in rows]
            common = round30(sum((w << 30) // sum(weights) * x for w, x in zip(weights, d)))
            for (r, _), w, x in zip(rows, weights, d):
                root = math.isqrt(w << 38)
                root -= root >> 2 if self.mode == 2 else 0
                values[r] = np.clip(values[r] + round_off((x - common) * root, 25), -2**29, 2**29)


# ---- 8.8 Inverse transform

def inverse_level(values, tree, grid_bits, level, modes, there=None):
    """8.8.1, 8.7.6: the merges of a level, and the corrections; modes are those of the planes; there: 8.12.4, by planes."""
    before = values.copy() if any(modes) else None
    undo_merges(values, tree, 3 * (grid_bits - level), 3 * (grid_bits - 1 - level))
    for mode in sorted(set(modes) - {0}):
        planes = [j for j, m in enumerate(modes) if m == mode]
        some = values[:, planes]
        of_planes = (lambda child: there(child, planes)) if there else None
        Prediction(tree, grid_bits, level, mode, of_planes).correct(some, before[:, planes])
        values[:, planes] = some


def undo_merges(values, tree, above, least):
    """8.8.1: undoes the merges of least <= split < above from the top down, a split at a time."""
    begin = 1
    while begin < len(tree.order) and tree.split[tree.order[begin]] >= above:
        begin += 1
    while begin < len(tree.order) and tree.split[tree.order[begin]] >= least:
        end, split = begin, tree.split[tree.order[begin]]
        while end < len(tree.order) and tree.split[tree.order[end]] == split:
            end += 1
        rows = tree.order[begin:end]
        left = [tree.left[r] for r in rows]
        rotations = np.array([tree.rotation(r) for r in rows], np.int64)
        c, s = rotations[:, :1], rotations[:, 1:]
        a, b = values[left], values[rows]
        values[left] = round30(c * a - s * b)
        values[rows] = round30(s * a + c * b)
        begin = end


# ---- 8.12 Predicted frames

class Reference:
    """8.12: what a frame leaves to the next."""

    def __init__(self, light_field):
        """8.12.2, 8.12.4, 8.12.5: cells of every level, means of every level, states by unit."""
        sequence, part = light_field.sequence, light_field.parts[0] if light_field.parts else None
        self.cells, self.means, self.states = [], [], light_field.left
        self.time = light_field.frame.time
        if part is None or not part.known:
            return
        codes = [morton(*node) for node in part.octree.nodes]
        for level in range(sequence.grid_bits + 1):     # none of a level that is not known
            above = 3 * (part.octree.level - level)
            cells = dict.fromkeys(code >> above for code in codes) if above >= 0 else {}
            self.cells.append({from_morton(code): i for i, code in enumerate(cells)})
        if part.tree:
            self.wanted = Wanted(sequence, 0, 0, 0)
            part.values(self.wanted, None, self.means)


class Moved:
    """8.12: a reference and the motion from it."""

    def __init__(self, reference, frame, sequence):
        """8.12.1: the motion of a frame."""
        require(reference and reference.cells and reference.cells[-1], "frame_predicted_flag")
        self.reference, self.frame, self.grid_bits = reference, frame, sequence.grid_bits
        require(MOVED in sequence.features or not frame.moves, "frame_lattice_log2", Unsupported)
        require(not frame.moves or sequence.cut_levels == sequence.grid_bits, "frame_predicted_flag")
        frame.read_vectors(reference.cells)
        if frame.moves:
            self.reference, self.frame = self.move_points(), None

    def move_points(self):
        """8.12.7: the reference with its points where they have moved."""
        bits, before, frame = self.grid_bits, self.reference, self.frame
        points = []                         # codes, and which point of the reference
        for p, (voxel, vector) in enumerate(zip(before.cells[bits], frame.vectors_of_points)):
            carried = [x + (d + 8 >> 4) + m for x, d, m in zip(voxel, self.displacement(voxel, bits), vector)]
            points.append((morton(*[min(max(y, 0), (1 << bits) - 1) for y in carried]), p))
        after = copied(before, cells=[], means=[])
        for level in range(bits + 1):
            held = {}
            for code, p in sorted(points):
                held.setdefault(code >> 3 * (bits - level), []).append(p)
            after.cells.append({from_morton(code): i for i, code in enumerate(held)})
            if before.means:
                values = [before.means[bits][rows].sum(axis=0) for rows in held.values()]
                after.means.append(np.array([(2 * v + len(rows)) // (2 * len(rows)) for v, rows in zip(values, held.values())]))
        return after

    def displacement(self, node, level):
        """8.12.1: D of a node."""
        frame = self.frame
        if not frame:                       # 8.12.7
            return [0] * 3
        place = [2 * x + 1 << self.grid_bits - level for x in node]
        from_centre = [p - (1 << self.grid_bits) for p in place]
        moved = [shift + (sum(m * p for m, p in zip(row, from_centre)) + (1 << 12) >> 13)
                 for shift, row in zip(frame.shift, frame.matrix)]
        if frame.lattice_log2:
            moved = [a + b for a, b in zip(moved, self.of_lattice(place))]
        return [min(max(part, -1 << 24), (1 << 24) - 16) for part in moved]

    def of_lattice(self, place):
        """8.12.1: L, of a place in halves of a voxel."""
        frame, h, cell, far, total = self.frame, 1 << self.frame.lattice_log2 + 1, [], [], [0] * 3
        for p, first, size in zip(place, frame.first, frame.size):
            u = min(max(p - first * h, 0), (size - 1) * h)
            cell.append(min(u // h, max(size - 2, 0)))
            far.append(u - cell[-1] * h)
        for b in itertools.product((0, 1), repeat=3):
            weight = math.prod(f if upper else h - f for f, upper in zip(far, b))
            if weight:
                vector = frame.vectors[tuple(c + upper for c, upper in zip(cell, b))]
                total = [t + 4 * v * weight for t, v in zip(total, vector)]
        bits = 3 * frame.lattice_log2 + 3
        return [t + (1 << bits - 1) >> bits for t in total]

    def there(self, node, level, occupied, unknown):
        """8.12.3: what the reference has about a node."""
        return There(self.reference.cells[level + 1], node, self.displacement(node, level),
                     self.grid_bits - level + 3, occupied, unknown)

    def terms(self, child, level, planes):
        """8.12.4: the weights of nodes of the reference for a node of a level, and their means."""
        t = self.grid_bits - level + 1
        y = [8 * x + (d + (1 << t - 1) >> t) for x, d in zip(child, self.displacement(child, level))]
        cells, found = self.reference.cells[level], []
        for b in CHILDREN:
            weight = math.prod(p & 7 if upper else 8 - (p & 7) for p, upper in zip(y, b))
            cell = tuple((p >> 3) + upper for p, upper in zip(y, b))
            if weight and cell in cells:
                found.append((weight, self.reference.means[level][cells[cell], planes]))
        total = sum(weight for weight, _ in found)
        shares = [4096 * weight // total for weight, _ in found]
        if found:
            shares[-1] = 4096 - sum(shares[:-1])
        return [(share, mean) for share, (_, mean) in zip(shares, found)]


    def sizes(self, tree, sequence):
        """8.12.6: h by row, for those that have it."""
        coded, found = self.reference.wanted.coded, {}
        steps = [sequence.steps[k][c] for k in coded for c in range(3)]
        for g in range(self.grid_bits):
            bits, values = 3 * (self.grid_bits - g - 1), {}
            merges = sorted((r for r in range(1, len(tree.codes)) if bits <= tree.split[r] < bits + 3), key=tree.split.__getitem__)
            nodes = {row for r in merges for row in (r, tree.left[r])}
            rows = tree.nodes(bits)
            for row, end in zip(rows, rows[1:] + [len(tree.codes)]):
                terms = self.terms(from_morton(tree.codes[row] >> bits), g + 1, slice(None)) if row in nodes else []
                if terms:
                    mean = sum(share * mean for share, mean in terms) >> 12
                    values[row] = round_off(mean * math.isqrt(tree.before[end] - tree.before[row] << 38), 19)
            for r in merges:
                a, b = values.pop(tree.left[r], None), values.pop(r, None)
                if a is not None and b is not None:
                    c, s = tree.rotation(r)
                    values[tree.left[r]] = round30(c * a + s * b)
                    found[r] = [min(4 * abs(int(x)) // step, 127) for x, step in zip(round30(c * b - s * a), steps)]
        return found


class There:
    """8.12.3: what the reference has about a node, and the contexts of it."""

    def __init__(self, cells, node, displacement, s, occupied, unknown):
        """8.12.3: the window, family and agreement; s: log2 of the side of a child, sixteenths of a voxel."""
        whole = [d + (1 << s - 1) >> s for d in displacement]
        self.beyond = [d - (w << s) >> s - 3 for d, w in zip(displacement, whole)]
        x, y, z = [2 * x - 1 + w for x, w in zip(node, whole)]
        self.cells = sum(window_bit(i, j, k) for i, j, k in itertools.product(range(4), repeat=3)
                         if (x + i, y + j, z + k) in cells)
        own = [window_bit(1 + cx, 1 + cy, 1 + cz) for cx, cy, cz in CHILDREN]
        self.family = sum(1 << c for c in range(8) if self.cells & own[c])
        known = (1 << 64) - 1 & ~(unknown | sum(own))
        right, false = (occupied & self.cells & known).bit_count(), ((occupied ^ self.cells) & known).bit_count()
        self.agreement = 4
        if right + false:
            self.agreement = 0 if not false else 1 if 4 * false <= right else 2 if false <= right else 3

    def density(self, seen):
        """8.12.3: density of a child with these cells around it."""
        total = 0
        for b in itertools.product((0, 1), repeat=3):
            place = [1 + upper * (-1 if e < 0 else 1) for e, upper in zip(self.beyond, b)]
            if seen & window_bit(*place):
                total += math.prod(abs(e) if upper else 8 - abs(e) for e, upper in zip(self.beyond, b))
        return total >> 5

    def predict(self, c, coded, hash_bits):
        """8.12.3: the indices of table 8-6, and the set of the fourth family."""
        seen = self.cells >> WINDOW_SHIFT[c] & (ALL | OWN_CELL)
        held, density, count = self.family >> c & 1, self.density(seen), (seen & ALL).bit_count()
        wrong = min(((self.family ^ coded) & (1 << c) - 1).bit_count(), 2)
        indices = (
            (((held * 17 + density) * 14 + count // 2) * 5 + self.agreement) * 3 + wrong,
            self.family * 256 + (1 << c | coded),
            hash_group((8 * seen + c) * HASH_A, 0, hash_bits, 0))
        return indices, ((held * 17 + density) * 5 + self.agreement) * 3 + wrong


# ---- 8.2 The base and slices

class Part:
    """8.2: the base (number None) or a slice, filled by its units."""

    def __init__(self, sequence, slices, number, base):
        """8.2: what it has and begins with; base is that of a slice, if any."""
        self.sequence, self.number, self.base = sequence, number, base
        self.is_base, self.apart = number is None, slices.apart and number is not None
        self.first, self.last = sequence.base_levels, sequence.grid_bits        # its levels
        self.points = sum(slices.cells)
        self.classes = [0] * self.points    # 8.4.5; of no meaning where K = 0
        if self.is_base:
            self.first, self.last = 0, sequence.base_levels
        else:
            self.points = slices.points[number]
            self.first_cell, self.num_cells = slices.first_cell[number], slices.cells[number]
        self.octree = self.tree = self.digest = self.normals = self.atlas = None
        self.known = 0                      # geometry units
        self.modes = {}                     # cu_prediction by (group, level of the grid)
        self.coders = []                    # of each group; arrays [P, planes] of components for textures
        self.refiners = {}                  # 8.7.7: coders by (layer, group)
        self.states = {}                    # 8.1: by type of unit and group
        self.moved = None                   # 8.12: the reference of a predicted frame
        self.sizes_there = None             # 8.12.6: h by row
        self.expected = sequence.unit_order(self.is_base)

    def take(self, kind):
        """7.1: the kind of a unit is the next one of the part."""
        require(self.expected and self.expected[0][0] == kind[0], "unit_type")
        element = {GEOMETRY: "level_range", COEFFICIENTS: "plane_group", REFINEMENT: "refinement_layer"}.get(kind[0])
        require(self.expected.pop(0) == kind, element)

    def begin_geometry(self):
        """8.2: the root, or the base cells of a slice."""
        if self.octree is None:
            cells = [(0, 0, 0)]
            if self.base:
                cells = self.base.octree.nodes[self.first_cell:self.first_cell + self.num_cells]
            self.octree = Octree(cells, self.first, self.points)
            self.octree.moved = self.moved

    def decode_geometry(self, decoder, level_range, state):
        """8.4.1: the levels of a range."""
        self.begin_geometry()
        self.octree.state = state
        if self.moved:
            state.add_reference()
        end = self.sequence.geometry_bounds[level_range + 1]
        while self.octree.level < end:
            self.octree.decode_level(decoder)
        self.known += 1
        if end == self.last:
            require(len(self.octree.nodes) == self.points,
                    "gu_occupancy" if self.is_base else "slice_num_points_minus1")
            if self.is_base and self.sequence.functions:
                self.classes = decode_classes(decoder, self.octree.nodes)
            self.make_tree()

    def make_tree(self):
        """8.6.1: rows and merges; 8.6.4, 8.7.2: cell rows, which have the scale of the base's."""
        shift = 3 * (self.sequence.grid_bits - self.last)
        weights = [1 << k for k in self.classes] if self.is_base else [1] * self.points
        self.tree = TransformTree([morton(*node) << shift for node in self.octree.nodes], weights)
        self.cell_rows = []
        if self.base:
            self.cell_rows = self.tree.nodes(3 * (self.sequence.grid_bits - self.first))
            for r, cell in self.adopted_rows():
                self.tree.scale[r] = self.base.tree.scale[cell]

    def adopted_rows(self):
        """8.7.2: cell rows behind row 0, with their base cells; none where slices are apart."""
        if not self.base or self.apart:
            return []
        return [(r, cell) for cell, r in enumerate(self.cell_rows, self.first_cell) if r]

    def decode_coefficients(self, decoder, level_range, group, state):
        """8.7.1: the rows of a level range, the functions of a group."""
        sequence = self.sequence
        if group == len(self.coders):
            before = self.coders[-1] if self.coders else None
            self.coders.append(sequence.coder(len(sequence.coded[group]), self.tree, before))
            for r, cell in self.adopted_rows():
                self.coders[group].adopt(self.base.coders[group], r, cell)
        begin, end = sequence.coefficient_bounds[level_range:level_range + 2]
        self.coders[group].state = state
        if self.moved and BY_REFERENCE in sequence.features:
            self.coders[group].there = lambda r: self.row_there(group, r)
        if sequence.coded[group] and decoder.codeword:
            self.coders[group].decode(decoder, self.tree.rows(begin, end, sequence.grid_bits))

    def row_there(self, group, r):
        """8.12.6: h in the planes of a group, and p."""
        if self.sizes_there is None:
            self.sizes_there = self.moved.sizes(self.tree, self.sequence)
        level = self.sequence.grid_bits - 1 - self.tree.split[r] // 3
        m = self.modes.get((group, level), 0) if r else 0
        h = self.sizes_there.get(r)
        functions = [self.moved.reference.wanted.coded.index(k) for k in self.sequence.coded[group]]
        return h and [h[3 * f + c] for f in functions for c in range(3)], 0 if m < 4 else 1 if m == 4 else 2

    def decode_refinement(self, decoder, level_range, group, layer, state):
        """8.7.7: one bit more of the values of a unit."""
        sequence, number = self.sequence, (layer, group)
        if number not in self.refiners:
            coarser = self.refiners[layer - 1, group] if layer > 1 else self.coders[group]
            before = self.refiners.get((layer, group - 1))
            self.refiners[number] = VectorCoder(len(sequence.coded[group]), self.tree, before, coarser)
            for r, cell in self.adopted_rows():
                self.refiners[number].adopt(self.base.refiners[number], r, cell)
        begin, end = sequence.coefficient_bounds[level_range:level_range + 2]
        rows = self.tree.rows(begin, end, sequence.grid_bits)
        self.refiners[number].state = state
        if not sequence.coded[group]:
            return
        if decoder.codeword:
            self.refiners[number].decode(decoder, rows)
        else:
            self.refiners[number].double(rows)

    def layers(self, wanted):
        """8.9: of every group wanted the coders of the layers that are there and wanted."""
        return [[coder] + [self.refiners[layer, group] for layer in range(1, wanted.layers)
                           if (layer, group) in self.refiners]
                for group, coder in enumerate(self.coders[:wanted.groups])]

    def decode_textures(self, reader, group):
        """7.6: flags, offsets and pictures of the planes of a group; 8.11.6: the components."""
        sequence = self.sequence
        steps = [sequence.steps[k][c] for k in sequence.groups[group] for c in range(3)]
        reader.align()
        flags, offsets, most = [], [], (1 << sequence.texture_bits) - 1
        for step in steps:
            flags.append(reader.u(1, "tx_picture_flag"))
            offsets.append(reader.se("tx_offset"))
            require(abs(offsets[-1]) < 1 << 30, "tx_offset")
            require(not flags[-1] or offsets[-1] + step * most < 1 << 30, "tx_offset")
        components = np.tile(np.array(offsets, np.int64), (self.points, 1))
        stream = reader.rest()
        if self.atlas is None:
            self.atlas = Atlas(self.octree.nodes, sequence.grid_bits, sequence.texture_cell_log2)
        if any(flags):
            pictures = decode_pictures(stream, sum(flags), sequence.texture_bits, self.atlas)
            planes = [plane for plane, flag in enumerate(flags) if flag]
            for plane, picture in zip(planes, pictures, strict=True):
                samples = picture[self.atlas.rows, self.atlas.columns].astype(np.int64)
                components[:, plane] += steps[plane] * samples
        else:
            require(not stream, "tx_pictures")
        self.coders.append(components)

    def values(self, wanted, base_values, means=None):
        """8.8: rows by planes, when the merges of the levels asked for are undone, with their corrections.

        means: 8.12.4, receives those of the nodes of every level.
        """
        sequence = self.sequence
        if sequence.texture:
            return texture_components(sequence, self.coders[:wanted.groups], self.points, wanted.coded)
        values = reconstruct(sequence, self.layers(wanted), self.points, wanted.coded)
        if self.base and not self.apart:
            points, run = np.diff(self.cell_rows + [self.points]).tolist(), slice(self.first_cell, self.first_cell + self.num_cells)
            values[self.cell_rows] = cell_values(base_values[run], points, [1 << k for k in self.base.classes[run]])
        if self.moved:                      # 8.12.4: the root
            root = self.moved.reference.means[0][0, self.columns_there(wanted, range(values.shape[1]))]
            values[0] = np.clip(values[0] + round_off(root * math.isqrt(self.points << 38), 19), -2**29, 2**29)
        if means is not None:
            means.append(self.means(values, 0))
        for level in range(self.first, min(self.last, wanted.levels)):
            modes = [0] * values.shape[1]
            for group, functions in enumerate(sequence.coded[:wanted.groups]):
                for r in map(wanted.coded.index, functions):
                    modes[3 * r:3 * r + 3] = [self.modes.get((group, level), int(sequence.prediction))] * 3
            inverse_level(values, self.tree, sequence.grid_bits, level, modes, self.terms_there(wanted, level + 1))
            if means is not None:
                means.append(self.means(values, level + 1))
        return values

    def means(self, values, level):
        """8.12.4: the means of the nodes of a level."""
        rows = self.tree.nodes(3 * (self.sequence.grid_bits - level))
        weights = np.diff([self.tree.before[r] for r in rows + [self.points]])
        scale = np.array([math.isqrt(2**60 // int(w)) for w in weights], np.int64)
        return np.clip(round30(values[rows] * scale[:, None]), 1 - 2**17, 2**17 - 1)

    def columns_there(self, wanted, planes):
        """8.12.4: where the means of planes of the functions asked for stand, among those of all."""
        whole = self.moved.reference.wanted.coded
        return [3 * whole.index(wanted.coded[j // 3]) + j % 3 for j in planes]

    def terms_there(self, wanted, level):
        """8.12.4: what the reference has for children of a level, by planes."""
        if not self.moved:
            return None
        return lambda child, planes: self.moved.terms(child, level, self.columns_there(wanted, planes))

    def nodes(self, wanted, base_values):
        """8.9.3, 8.8: points, or nodes of a level."""
        rows = self.tree.nodes(3 * wanted.shift)
        values = self.values(wanted, base_values)
        weights = np.diff([self.tree.before[r] for r in rows + [self.points]])
        if self.sequence.texture:
            values = mean(values, rows, weights)
        elif self.is_base or wanted.shift:
            scale = np.array([math.isqrt(2**60 // int(w)) for w in weights], np.int64)
            values = round30(values[rows] * scale[:, None])
        positions = np.array(self.octree.nodes, np.int64) << self.sequence.grid_bits - self.last
        normals = np.zeros((len(rows), 2), np.int64) if self.normals is None else self.normals[rows]
        components = values.reshape(len(rows), len(wanted.coded), 3)
        if self.digest and wanted.all and not self.expected:
            check_digest(self.digest, positions, components, normals if self.sequence.normal_bits else None)
        if self.apart:
            components = components + self.cell_means(rows, base_values).reshape(components.shape)
        return positions[rows] >> wanted.shift, components, normals

    def cell_means(self, rows, base_values):
        """8.8.3: by row the means of the base cell it lies in."""
        cells = np.searchsorted(self.cell_rows, rows, "right") - 1 + self.first_cell
        scale = np.array([math.isqrt(2**60 >> k) for k in self.base.classes], np.int64)
        return round30(base_values * scale[:, None])[cells]

    def deepest_nodes(self, wanted, base_values):
        """8.9.2: the nodes of the deepest level known, for want of geometry."""
        sequence = self.sequence
        if not self.known and (not self.base or sequence.cut_slices):
            return nothing(wanted)
        self.begin_geometry()
        nodes = np.array(self.octree.nodes, np.int64)
        side = 1 << sequence.grid_bits - self.octree.level
        positions = nodes * side + side // 2 >> wanted.shift
        if not self.base:
            return positions, np.zeros((len(nodes), len(wanted.coded), 3), np.int64), np.zeros((len(nodes), 2), np.int64)
        known = copied(self, points=len(nodes), last=self.octree.level, coders=[], digest=None, normals=None)
        known.make_tree()
        _, components, normals = known.nodes(wanted, base_values)
        return positions[known.tree.nodes(3 * wanted.shift)], components, normals


# ---- 8.9 Partial and coarser light fields

class Wanted:
    """8.9: the levels, groups and layers that are given out."""

    def __init__(self, sequence, levels, groups, layers):
        """8.9: what is asked for, 0: all; less if the stream was cut."""
        self.levels = min(levels or sequence.grid_bits, sequence.cut_levels)
        self.groups = min(groups or 16, sequence.cut_groups or 16, len(sequence.groups))
        self.shift = sequence.grid_bits - self.levels
        self.coded = sequence.coded_functions(self.groups) if self.groups else []
        most = max(sequence.layers, default=1)
        self.layers = min(layers or most, sequence.cut_layers or most)
        self.all = self.shift == 0 and self.groups == len(sequence.groups) and self.layers == most


def nothing(wanted):
    """8.9: no points."""
    return np.zeros((0, 3), np.int64), np.zeros((0, len(wanted.coded), 3), np.int64), np.zeros((0, 2), np.int64)


def in_region(sequence, positions, shift, region):
    """8.9.4: which cubes meet a box of the world, six numbers; its corners are put on the grid by 6.1."""
    low, high = [[math.floor((v - o) / sequence.step + 0.5) for v, o in zip(corner, sequence.origin)]
                 for corner in (region[:3], region[3:])]
    return (((positions << shift) <= high) & ((positions + 1 << shift) - 1 >= low)).all(axis=1)


# ---- 8.10 Normals

def size(v):
    """8.10: size(v)."""
    return min(abs(v), 2)


def decode_normals(decoder, points, bits):
    """8.10: two coordinates a point, as residuals to the point before."""
    contexts = [(Contexts(2), MagnitudeContexts()) for _ in range(4)]
    normals, half = np.zeros((points, 2), np.int64), 1 << (bits - 1)
    before = [0, 0]
    for i in range(points):
        residual = 0
        for coordinate in range(2):
            signs, magnitude = contexts[1 + size(residual) if coordinate else 0]
            residual = 0
            if decoder.adaptive(signs, 0, 255):
                negative = decoder.adaptive(signs, 1, 255)
                residual = decoder.magnitude(magnitude, 255, "nu_magnitude")
                require(residual <= (half if negative else half - 1), "nu_magnitude")
                residual = -residual if negative else residual
            before[coordinate] = (before[coordinate] + residual) % (2 * half)
        normals[i] = before
    return normals


# ---- 8.11 Texture

def neighbours_of(place):
    """8.4.1: the places around a place and itself, in ascending direction."""
    x, y, z = place
    return [(x + dx, y + dy, z + dz) for dx, dy, dz in DIRECTIONS]


def round_up(value, multiple):
    """8.11.3, 8.11.4: the next multiple."""
    return -(-value // multiple) * multiple


def cell_axes(cells):
    """8.11.2: the axis of every cell, which is that of its block."""
    blocks = {}                             # 8.11.1: numbers of the cells of a block
    for i, (x, y, z) in enumerate(cells):
        blocks.setdefault((x >> 2, y >> 2, z >> 2), []).append(i)
    around_block = {block: [near for near in neighbours_of(block) if near in blocks] for block in blocks}
    places = np.array(cells, np.int64)
    axes = {}
    for block, near in around_block.items():
        d = places[[i for other in near for i in blocks[other]]] - 4 * np.array(block)
        m = d.sum(axis=0)
        cov = (len(d) * (d.T @ d) - np.outer(m, m)).tolist()
        flatness = [cov[b][b] * cov[c][c] - cov[b][c] ** 2 for b, c in ((1, 2), (0, 2), (0, 1))]
        axes[block] = flatness.index(max(flatness))
    for _ in range(2):
        before, axes = axes, {}
        for block, near in around_block.items():
            votes = [0, 0, 0]
            for other in near:
                votes[before[other]] += len(blocks[other])
            best = votes.index(max(votes))
            axes[block] = best if votes[best] > votes[before[block]] else before[block]
    result = [0] * len(cells)
    for block, members in blocks.items():
        for i in members:
            result[i] = axes[block]
    return result


class Chart:
    """8.11.3: cells of one axis, by (u, v)."""

    def __init__(self, cells, axes, first, taken, extent):
        """8.11.3: grows the chart from the cell first; cells maps places to numbers, extent is E."""
        self.axis, self.cells = axes[first[0]], {}
        self.least, self.most = list(self.uv(first[1])), list(self.uv(first[1]))
        queue = [first[1]]
        taken.add(first[0])
        self.cells[self.uv(first[1])] = first[0]
        for place in queue:                 # grows while it is read
            for near in neighbours_of(place):
                i = cells.get(near)
                if i is None or i in taken or axes[i] != self.axis or self.uv(near) in self.cells:
                    continue
                least = [min(pair) for pair in zip(self.least, self.uv(near))]
                most = [max(pair) for pair in zip(self.most, self.uv(near))]
                if any(b - a + 1 > extent for a, b in zip(least, most)):
                    continue
                self.least, self.most = least, most
                taken.add(i)
                self.cells[self.uv(near)] = i
                queue.append(near)
        self.extents = [b - a + 1 for a, b in zip(self.least, self.most)]
        w, h = [round_up(extent, 4) for extent in self.extents]
        self.kept = len(self.cells) >= 16 and 8 * len(self.cells) >= w * h
        self.width, self.height = max(w, h), min(w, h)              # 8.11.4: the box

    def uv(self, place):
        """8.11.3: (u, v) of a cell."""
        x, y, z = place
        return ((y, z), (x, z), (x, y))[self.axis]

    def pixels(self):
        """8.11.5: cell, column and row in the box."""
        turned = self.extents[1] > self.extents[0]
        for (u, v), i in self.cells.items():
            a, b = u - self.least[0], v - self.least[1]
            yield (i, b, a) if turned else (i, a, b)


class Atlas:
    """8.11: the size W x H of the pictures of a slice, and the pixel of every point."""

    def __init__(self, points, grid_bits, cell_log2):
        """8.11.1, 8.11.3 - 8.11.5: from the points, in Morton order."""
        cell_of = [(x >> cell_log2, y >> cell_log2, z >> cell_log2) for x, y, z in points]
        first = [i for i, cell in enumerate(cell_of) if i == 0 or cell != cell_of[i - 1]]
        cells = {cell_of[i]: number for number, i in enumerate(first)}
        axes = cell_axes(list(cells))
        taken, charts = set(), []
        for place, number in cells.items():
            if number not in taken:
                chart = Chart(cells, axes, (number, place), taken, 1 << min(9, max(grid_bits - cell_log2, 0)))
                if chart.kept:
                    charts.append(chart)
        charted = {first[number] for chart in charts for number in chart.cells.values()}
        loose = [i for i in range(len(points)) if i not in charted]
        area = len(loose) + sum(chart.width * chart.height for chart in charts)
        widest = max((chart.width for chart in charts), default=0)
        self.width = max(64, round_up(widest, 8), round_up(math.isqrt(area * 5 // 4), 8))
        self.columns, self.rows = np.zeros((2, len(points)), np.int64)
        base = self.place_boxes(charts, first)
        tiles = -(-len(loose) // 64)
        self.height = max(64, base + 8 * -(-tiles // (self.width // 8)))
        require(self.height <= 8192, "texture_size")
        self.place_loose(loose, base)

    def place_boxes(self, charts, first):
        """8.11.4: places the boxes, 8.11.5: and the first points in them; gives B."""
        heights = np.zeros(self.width // 4, np.int64)
        for chart in sorted(charts, key=lambda chart: (-chart.height, -chart.width)):
            count = chart.width // 4
            highest = np.lib.stride_tricks.sliding_window_view(heights, count).max(axis=1)
            x = int(highest.argmin())
            y = int(highest[x])
            heights[x:x + count] = y + chart.height
            for number, a, b in chart.pixels():
                self.columns[first[number]], self.rows[first[number]] = 4 * x + a, y + b
        return round_up(int(heights.max()), 8)

    def place_loose(self, loose, base):
        """8.11.5: the pixels of the loose points."""
        i = np.arange(len(loose))
        t, q = i // 64, i % 64
        across = self.width // 8
        self.columns[loose] = 8 * (t % across) + (q & 1) + 2 * (q >> 2 & 1) + 4 * (q >> 4 & 1)
        self.rows[loose] = base + 8 * (t // across) + (q >> 1 & 1) + 2 * (q >> 3 & 1) + 4 * (q >> 5 & 1)


NAL_TYPES = {*hevc.SLICE_SEGMENTS, hevc.VPS, hevc.SPS, hevc.PPS, hevc.ACCESS_UNIT_DELIMITER, hevc.FILLER_DATA,
             hevc.PREFIX_SEI, hevc.SUFFIX_SEI}                      # 7.6


def decode_pictures(stream, count, bits, atlas):
    """7.6: the pictures of a unit, in output order (8.11.6), and what they may be."""
    try:
        types = [nal_type for nal_type, _ in hevc.headers(stream)]
        require(all(layer == 0 for _, layer in hevc.headers(stream)), "hevc_nal_unit (layer)")
        require(all(nal_type in NAL_TYPES for nal_type in types), "hevc_nal_unit (type)")
        require(hevc.coded_pictures(stream) == count, "hevc_pictures (number)")
        for parameter_set in (hevc.VPS, hevc.SPS, hevc.PPS):
            require(types.count(parameter_set) <= count, "hevc_pictures (parameter sets)")
        for facts in hevc.sequence_parameters(stream):
            require(facts["chroma_format_idc"] == 0, "chroma_format_idc")
            require(facts["bits"] == bits, "bit_depth_luma_minus8")
            for name, wanted in (("width", atlas.width), ("height", atlas.height)):
                require(facts[name] == wanted, f"pic_{name}_in_luma_samples (conformance window)")
                require(facts["coded_" + name] < wanted + 64, f"pic_{name}_in_luma_samples")
            require(not facts["scaling_list_enabled_flag"], "scaling_list_enabled_flag")
            require(not facts["pcm_enabled_flag"], "pcm_enabled_flag")
        pictures = 0
        for picture in hevc.decode(stream):
            pictures += 1
            yield picture
        require(pictures == count, "hevc_pictures (number)")
    except hevc.Unsupported as problem:
        raise Unsupported(f"hevc_pictures (HEVC is not supported: {problem})") from None
    except hevc.Damaged as problem:
        raise Refused(str(problem)) from None


def texture_components(sequence, groups, points, coded):
    """8.11.6: the components by point and plane; those of missing groups are 0 (8.9)."""
    values = np.zeros((points, 3 * len(coded)), np.int64)
    for functions, components in zip(sequence.groups, groups):
        values[:, [3 * coded.index(k) + c for k in functions for c in range(3)]] = components
    return values


def mean(values, first, weights):
    """8.11.6: the mean over the points of every node, to nearest, halves away from zero."""
    sums, weights = np.add.reduceat(values, first, axis=0), weights[:, None]
    return np.sign(sums) * ((2 * abs(sums) + weights) // (2 * weights))


# ---- 8.1 The whole stream

class LightField:
    """8.1: what the units of a stream make."""

    def __init__(self, sequence, frame=None, reference=None):
        """8.1: nothing but the sequence; of one that moves the frame unit, and of a predicted frame the reference."""
        self.frame, self.reference = frame, reference
        self.empty = EMPTY in sequence.features
        self.left = {}                      # 8.12.5: the states after each unit
        self.sequence, self.slices, self.base, self.parts = sequence, None, None, []
        self.boxes = None
        self.handed = {}                    # 8.1: the states after each unit of slice 0
        self.metadata = False

    def read(self, units):
        """7.1: all units behind the sequence."""
        for number, (unit_type, payload, _) in enumerate(units[1:], 1):
            require(unit_type != SEQUENCE, "unit_type")
            require(len(payload) <= LEVELS[self.sequence.level][2], "unit_length")              # 9
            require(not self.empty or unit_type not in OF_POINTS, "unit_type (of an empty frame)")
            if unit_type == SLICES:
                self.read_slices(payload)
            elif unit_type in (GEOMETRY, NORMALS, COEFFICIENTS, DIGEST, REFINEMENT):
                require(self.slices, "unit_type (before the slices unit)")
                self.read_unit(unit_type, BitReader(payload))
            elif unit_type == TRANSFORM:
                transforms = self.sequence.transforms
                require(not self.slices and len(transforms) < self.sequence.num_transforms, "unit_type (transform)")
                transforms.append(Transform(self.sequence, payload))
            elif unit_type == INDEX:
                self.boxes = check_index(self.sequence, payload, units[number + 1:])
            elif unit_type == METADATA:
                require(not self.metadata, "unit_type (metadata)")
                self.metadata = True
                check_metadata(payload)
            elif unit_type == END:
                check_end(payload, number)
                self.check_whole()
            elif unit_type == FRAME:
                require(number == 1 and self.frame and not self.reference, "unit_type (frame)")
            else:
                require(unit_type == FILLER or unit_type & 64, "unit_type", Unsupported)    # 7.1.1
        if self.boxes and self.slices:
            check_boxes(self.boxes, self.slices, self.base.octree.nodes if self.base.tree else None)

    def read_slices(self, payload):
        """7.3: the slices unit, once, behind the transforms."""
        sequence = self.sequence
        require(not self.slices, "unit_type (slices)")
        require(len(sequence.transforms) == sequence.num_transforms, "sps_num_transforms_minus1")
        self.slices = Slices(sequence, payload)
        self.check_level()
        self.base = Part(sequence, self.slices, None, None) if sequence.base_levels else None
        self.parts = [Part(sequence, self.slices, s, self.base) for s in range(len(self.slices.cells))]
        self.fresh_octree = OctreeState(sum(self.slices.points))
        if self.reference:
            self.parts[0].moved = Moved(self.reference, self.frame, sequence)

    def check_level(self):
        """9: the limits of table 9-1 that the slices unit is held to."""
        sequence, points = self.sequence, sum(self.slices.points)
        rows, values, _, rate = LEVELS[sequence.level]
        count = points + (sum(self.slices.cells) if sequence.base_levels else 0)
        require(count <= rows, "sps_level (rows)")
        require(count * max(3 * sequence.functions, 1) <= values, "sps_level (values)")
        if self.reference and sequence.level:
            require(points <= rate * (self.frame.time - self.reference.time), "frame_time (points a second)")

    def check_whole(self):
        """7.1: before the end unit nothing is missing that was not left out; 7.13: what is empty is a frame."""
        require(self.frame or not self.empty, "unit_type (frame)")
        if not self.empty and not self.sequence.cut:
            require(self.slices, "unit_type (slices)")
            for part in [self.base] * bool(self.base) + self.parts:
                require(not part.expected, "unit_type (missing)")

    def read_unit(self, unit_type, reader):
        """7.4 - 7.6, 7.9: a unit of the base or of a slice, which must be the next one of it by 7.1."""
        sequence = self.sequence
        number, kind = sequence.unit_kind(unit_type, reader)
        if number is None:
            part = self.base
        else:
            require(number < len(self.parts), "slice_id")
            part = self.parts[number]
            require(not self.base or not self.base.expected, "unit_type (the base is not complete)")
        if unit_type == DIGEST:
            require(not part.expected and part.digest is None and not sequence.cut, "unit_type (digest)")
            part.digest = reader.rest()
            require(len(part.digest) == 32, "digest_sha256")
            return
        part.take(kind)
        if unit_type == NORMALS:
            decoder = ArithmeticDecoder(reader.rest())
            part.normals = decode_normals(decoder, part.points, sequence.normal_bits)
            decoder.finish("nu_normals")
        elif unit_type == GEOMETRY:
            decoder = ArithmeticDecoder(reader.rest())
            new = (lambda: OctreeState(part.points)) if part.apart else self.fresh_octree.copy
            part.decode_geometry(decoder, kind[1], self.start_state(part, kind, new))
            with_classes = part.is_base and part.tree and sequence.functions
            decoder.finish("gu_weight_class" if with_classes else "gu_occupancy")
        elif unit_type == REFINEMENT:
            self.read_refinement(part, kind, reader)
        elif sequence.texture:
            part.decode_textures(reader, kind[2])
        else:
            self.read_coefficients(part, kind, reader)
        self.hand_on(part, kind)

    def read_coefficients(self, part, kind, reader):
        """7.6: the modes of a coefficient unit and its codeword."""
        sequence, (_, level_range, group) = self.sequence, kind
        if sequence.prediction:
            for level in range(*sequence.coefficient_bounds[level_range:level_range + 2]):
                part.modes[group, level] = reader.u(3 if sequence.predicted else 2, "cu_prediction")
        functions = len(sequence.coded[group])
        codeword = self.read_matrix(kind, reader)
        state = self.start_state(part, kind, lambda: sequence.coder.new_state(functions))
        decoder = ArithmeticDecoder(codeword)
        part.decode_coefficients(decoder, level_range, group, state)
        decoder.finish("cu_coefficients")

    def read_matrix(self, kind, reader):
        """7.6, 7.11: the columns of a group, before its first coefficients; what is behind them."""
        size, (_, level_range, group) = 0, kind
        if self.sequence.predicted:
            return reader.rest()
        if self.sequence.num_transforms and level_range == 0:
            size = reader.ue("cu_matrix_bytes")
        rest = reader.rest()
        require(size <= len(rest), "cu_matrix_bytes")
        transforms = [t for t in self.sequence.transforms if t.columns.get(group)]
        require(transforms or not size, "cu_matrix_bytes")
        if level_range == 0:
            for transform in transforms:
                transform.read_columns(ArithmeticDecoder(rest[:size]), group)
        return rest[size:]

    def read_refinement(self, part, kind, reader):
        """7.12: the codeword of a refinement unit."""
        _, level_range, group, layer = kind
        functions = len(self.sequence.coded[group])
        state = self.start_state(part, kind, lambda: VectorState(functions))
        decoder = ArithmeticDecoder(reader.rest())
        part.decode_refinement(decoder, level_range, group, layer, state)
        decoder.finish("cu_coefficients")

    def start_state(self, part, kind, new):
        """8.1: the state that a unit starts from."""
        what = kind[0], kind[2:]
        if self.reference:                  # 8.12.5
            require(kind in self.reference.states, "frame_predicted_flag")
            part.states[what] = self.reference.states[kind].copy()
            return part.states[what]
        if part.number and self.slices.shared:
            require(kind in self.handed, "slice_id (before the unit of slice 0)")
            return self.handed[kind].copy()
        if what not in part.states:
            part.states[what] = part.base.states[what].copy() if part.base and not part.apart else new()
        return part.states[what]

    def hand_on(self, part, kind):
        """8.1: what a unit of slice 0 has left, for those that start from it."""
        what = kind[0], kind[2:]
        if part.number == 0 and self.slices.shared and what in part.states:
            self.handed[kind] = part.states[what].copy()
        if self.frame and what in part.states:
            self.left[kind] = part.states[what].copy()
        if not part.is_base and part.tree:
            part.states.pop((GEOMETRY, ()), None)

    def output(self, wanted):
        """8.9.2: positions, components and normals, part by part."""
        if not self.slices:
            return [nothing(wanted)]
        if self.base and not self.base.tree:
            return [self.base.deepest_nodes(wanted, None)]
        if wanted.levels <= self.sequence.base_levels:
            return [self.base.nodes(wanted, None)]
        base_values = self.base.values(wanted, None) if self.base else None
        return [part.nodes(wanted, base_values) if part.tree else part.deepest_nodes(wanted, base_values)
                for part in self.parts]


def given_out(sequence, light_field, wanted, region):
    """8.9: positions, components and normals of what is asked for."""
    positions, components, normals = [np.concatenate(arrays) for arrays in zip(*light_field.output(wanted))]
    keep = np.ones(len(positions), bool)
    keep[1:] = (positions[1:] != positions[:-1]).any(axis=1)        # 8.9.2: equal ones are counted once
    if region:
        keep &= in_region(sequence, positions, wanted.shift, region)
    return positions[keep], components[keep], normals[keep]


def light_fields(data):
    """7.13, 8.12: of every frame, in order, its units and light field; of a stream that does not move those of the stream."""
    sequence = reference = None
    for frame, own in list(split_frames(data)):
        units = read_units(own, bool(frame and frame.predicted))
        if frame and frame.predicted:
            require(EMPTY not in sequence.features, "frame_predicted_flag")
            require(not {INDEX, METADATA} & {unit_type for unit_type, _, _ in units}, "unit_type (predicted frame)")
            light_field = LightField(copied(sequence, predicted=True), frame, reference)
        else:
            sequence = Sequence(units[0][1])
            light_field = LightField(sequence, frame)
        if frame:
            require(sequence.profile == 0, "sps_profile")
            require(sequence.base_levels == 0, "sps_base_levels")
            with_vectors = not sequence.functions or sequence.coder is VectorCoder and max(sequence.layers) == 1
            require(with_vectors, "sps_coefficient_coder")
        if frame and units[-1][0] == END:
            behind = sum(size for _, _, size in units[2 - frame.predicted:])
            require(frame.bytes == behind, "frame_bytes")
        light_field.read(units)
        yield units, light_field
        reference = Reference(light_field) if frame else None


def decode(data, levels, groups, layers, region):
    """8.1: units in; sequence, coded functions, positions, components, normals out; of the first frame."""
    light_field = next(light_fields(data))[1]
    sequence = light_field.sequence
    wanted = Wanted(sequence, levels, groups, layers)
    return sequence, wanted.coded, *given_out(sequence, light_field, wanted, region)


def description(units, sequence, coded, points, levels, groups, layers, region):
    """6, 8.9: light_field.json: the header, and whether the light field is all there is."""
    wanted = Wanted(sequence, levels, groups, layers)
    whole = wanted.all and not region and not sequence.cut and units[-1][0] == END
    return {**header_of(sequence, wanted.shift), "component_function": coded, "points": points,
            "normal_bits": sequence.normal_bits, "partial": not whole}


def write(directory, sequence, coded, arrays, with_planes):
    """8.9: positions, components and normals as arrays, and the given planes."""
    positions, components, normals = arrays
    os.makedirs(directory, exist_ok=True)
    np.save(os.path.join(directory, "positions.npy"), positions.astype("<i4"))
    np.save(os.path.join(directory, "components.npy"), components.astype("<i4"))
    if with_planes:
        planes = given_planes(sequence, coded, components.astype(np.int64))
        np.save(os.path.join(directory, "planes.npy"), planes.astype("<i4"))
    if sequence.normal_bits:
        np.save(os.path.join(directory, "octahedral.npy"), normals.astype("<u2"))


def main():
    """8.9: decodes a file, with --levels, --groups, --layers and --region."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=["decode"])
    parser.add_argument("stream")
    parser.add_argument("--dump", metavar="DIRECTORY")
    parser.add_argument("--levels", type=int, default=0)
    parser.add_argument("--groups", type=int, default=0)
    parser.add_argument("--layers", type=int, default=0)
    parser.add_argument("--region", type=lambda text: [float(word) for word in text.split(",")], default=[])
    parser.add_argument("--planes", action="store_true")
    arguments = parser.parse_args()
    if len(arguments.region) not in (0, 6):
        parser.error("--region takes x0,y0,z0,x1,y1,z1")
    request = arguments.levels, arguments.groups, arguments.layers
    try:
        with open(arguments.stream, "rb") as file:
            data = file.read()
        for units, light_field in light_fields(data):
            sequence, wanted = light_field.sequence, Wanted(light_field.sequence, *request)
            arrays = given_out(sequence, light_field, wanted, arguments.region)
            frame, directory, said = light_field.frame, arguments.dump, []
            if frame:
                directory = directory and os.path.join(directory, f"frame_{frame.number}")
                said = ["frame", frame.number, "time", frame.time, "predicted" if frame.predicted else "intra"]
            if directory:
                write(directory, sequence, wanted.coded, arrays, arguments.planes)
                about = description(units, sequence, wanted.coded, len(arrays[0]), *request, arguments.region)
                with open(os.path.join(directory, "light_field.json"), "w", encoding="utf-8") as file:
                    json.dump(about, file, indent=2)
            print(*said, "points", len(arrays[0]), "functions", sequence.functions, flush=True)
    except (Refused, OSError) as problem:
        print(getattr(problem, "said", "refused") + ":", problem, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
