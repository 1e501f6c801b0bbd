# SPDX-License-Identifier: Apache-2.0
"""HEVC pictures for decoder.py, by libde265 through ctypes. An adapter: what a stream may hold is the
specification's to say and decoder.py's to check; nothing here is about the format.

Needs the shared library libde265.so.0 (Debian: libde265-0). H.265 is ITU-T H.265.
"""
import ctypes

import numpy as np

LIBRARY = "libde265.so.0"
IMAGE_BUFFER_FULL, WAITING_FOR_INPUT_DATA = 9, 13
# nal_unit_type, H.265 table 7-1
SLICE_SEGMENTS = (*range(10), *range(16, 22))
VPS, SPS, PPS, ACCESS_UNIT_DELIMITER, FILLER_DATA, PREFIX_SEI, SUFFIX_SEI = 32, 33, 34, 35, 38, 39, 40


class Unsupported(Exception):
    """There is no library to decode HEVC with."""


class Damaged(Exception):
    """The byte stream is none, or the library reports an error or a warning."""


class BitReader:
    """H.265 7.2, 9.2: reads a NAL unit without its emulation prevention bytes."""

    def __init__(self, data):
        """H.265 7.3.1.1: leaves out the 03 of 00 00 03."""
        payload = data.replace(b"\0\0\3", b"\0\0")
        self.bits = "".join(f"{byte:08b}" for byte in payload)
        self.position = 0

    def u(self, count):
        """H.265 7.2: u(n)."""
        self.position += count
        if self.position > len(self.bits):
            raise Damaged("hevc_parameter_sets (truncated)")
        return int("0" + self.bits[self.position - count:self.position], 2)

    def ue(self):
        """H.265 9.2: ue(v)."""
        zeros = 0
        while self.u(1) == 0:
            zeros += 1
            if zeros > 32:
                raise Damaged("hevc_parameter_sets")
        return (1 << zeros) - 1 + self.u(zeros)


def nal_units(data):
    """H.265 B.1: the NAL units of a byte stream."""
    start, *units = data.split(b"\0\0\1")
    if start.strip(b"\0"):
        raise Damaged("hevc_start_code")
    units = [unit.rstrip(b"\0") for unit in units]
    if any(len(unit) < 2 for unit in units):
        raise Damaged("hevc_nal_unit")
    return units


def headers(data):
    """H.265 7.3.1.2: nal_unit_type and nuh_layer_id of every NAL unit."""
    return [(unit[0] >> 1 & 63, (unit[0] & 1) << 5 | unit[1] >> 3) for unit in nal_units(data)]


def coded_pictures(data):
    """H.265 7.3.6.1: the number of slice segments that begin a picture."""
    return sum(unit[0] >> 1 in SLICE_SEGMENTS and unit[2:3] >= b"\x80" for unit in nal_units(data))


def sequence_parameters(data):
    """H.265 7.3.2.2: of every sequence parameter set what a format may limit."""
    found = []
    for unit in nal_units(data):
        if unit[0] >> 1 != SPS:
            continue
        reader = BitReader(unit[2:])
        reader.u(4)
        sub_layers = reader.u(3)
        reader.u(1 + 96)                                            # profile_tier_level, the general part
        present = [(reader.u(1), reader.u(1)) for _ in range(sub_layers)]
        reader.u(2 * (8 - sub_layers) if sub_layers else 0)
        for profile, level in present:
            reader.u(88 * profile + 8 * level)
        reader.ue()
        facts = {"chroma_format_idc": reader.ue()}
        if facts["chroma_format_idc"] == 3:
            reader.u(1)
        facts["coded_width"], facts["coded_height"] = reader.ue(), reader.ue()
        # the window is in chroma samples: two luma samples across for 4:2:0 and 4:2:2, two down for 4:2:0
        across = 2 if facts["chroma_format_idc"] in (1, 2) else 1
        down = 2 if facts["chroma_format_idc"] == 1 else 1
        left, right, top, bottom = [reader.ue() for _ in range(4)] if reader.u(1) else [0] * 4
        facts["width"] = facts["coded_width"] - across * (left + right)
        facts["height"] = facts["coded_height"] - down * (top + bottom)
        facts["bits"] = reader.ue() + 8
        reader.ue(), reader.ue()
        for _ in range(sub_layers + 1 if reader.u(1) else 1):
            reader.ue(), reader.ue(), reader.ue()
        for _ in range(6):
            reader.ue()
        facts["scaling_list_enabled_flag"] = reader.u(1)
        facts["pcm_enabled_flag"] = 0
        if not facts["scaling_list_enabled_flag"]:                  # else lists may follow: not read
            reader.u(2)
            facts["pcm_enabled_flag"] = reader.u(1)
        found.append(facts)
    return found


def load():
    """The library with the types of its functions."""
    try:
        library = ctypes.CDLL(LIBRARY)
    except OSError:
        raise Unsupported(f"{LIBRARY} is missing") from None
    pointer, number = ctypes.c_void_p, ctypes.c_int
    types = {
        "new_decoder": (pointer, []),
        "free_decoder": (number, [pointer]),
        "push_data": (number, [pointer, ctypes.c_char_p, number, ctypes.c_int64, pointer]),
        "flush_data": (number, [pointer]),
        "decode": (number, [pointer, ctypes.POINTER(number)]),
        "get_warning": (number, [pointer]),
        "get_next_picture": (pointer, [pointer]),
        "get_image_width": (number, [pointer, number]),
        "get_image_height": (number, [pointer, number]),
        "get_bits_per_pixel": (number, [pointer, number]),
        "get_image_plane": (pointer, [pointer, number, ctypes.POINTER(number)]),
        "get_error_text": (ctypes.c_char_p, [number]),
    }
    for name, (result, arguments) in types.items():
        function = getattr(library, "de265_" + name)
        function.restype, function.argtypes = result, arguments
    return library


def samples(library, image):
    """The luma of a picture within its conformance window, copied."""
    stride = ctypes.c_int()
    plane = library.de265_get_image_plane(image, 0, ctypes.byref(stride))
    width, height = library.de265_get_image_width(image, 0), library.de265_get_image_height(image, 0)
    bits = library.de265_get_bits_per_pixel(image, 0)
    kind = np.dtype("u1" if bits <= 8 else "<u2")
    picture = np.empty((height, width), kind)
    for row in range(height):
        line = ctypes.string_at(plane + row * stride.value, width * kind.itemsize)
        picture[row] = np.frombuffer(line, kind)
    return picture


def decode(data):
    """Gives the pictures of a byte stream one after the other, in output order, as arrays [height, width]."""
    library = load()
    context = library.de265_new_decoder()
    try:
        def check(error):
            """Any error or warning but the two that are no faults."""
            if error not in (0, IMAGE_BUFFER_FULL, WAITING_FOR_INPUT_DATA):
                raise Damaged(f"hevc_slice_data ({library.de265_get_error_text(error).decode()})")

        check(library.de265_push_data(context, data, len(data), 0, None))
        check(library.de265_flush_data(context))
        more, stalled = ctypes.c_int(1), False
        while more.value and not stalled:
            error = library.de265_decode(context, ctypes.byref(more))
            check(error)
            check(library.de265_get_warning(context))
            stalled = error != 0
            while image := library.de265_get_next_picture(context):
                stalled = False
                yield samples(library, image)
        if stalled:
            raise Damaged("hevc_slice_data (truncated)")
    finally:
        library.de265_free_decoder(context)
