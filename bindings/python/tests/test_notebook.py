# SPDX-License-Identifier: Apache-2.0
"""What notebooks show, and pickling."""
import base64
import io
import pickle
import re
import struct
import unittest
import zlib

import numpy as np

import slf
from test_frames import stream
from test_slf import disc


def pixels(png):
    """The picture of an 8-bit RGB PNG without filters."""
    at, data, shape = 8, b'', None
    while at < len(png):
        length, kind = struct.unpack('>I4s', png[at:at + 8])
        body = png[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack('>I', png[at + 8 + length:at + 12 + length])[0]
        if kind == b'IHDR':
            shape = struct.unpack('>II', body[:8])
        data += body if kind == b'IDAT' else b''
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(shape[1], 1 + 3 * shape[0])
    return rows[:, 1:].reshape(shape[1], shape[0], 3)


class NotebookTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.field = slf.read(slf.encode(disc(), q=2, grid_bits=7).data)

    def test_a_field_is_shown_as_its_picture(self):
        wanted = self.field.render(self.field.orbit(0.1, size=(400, 400)))
        self.assertTrue(np.array_equal(pixels(self.field._repr_png_()), wanted))
        integers = slf.read(slf.pack(np.eye(3, dtype=int), np.zeros((3, 1, 3), int)))
        self.assertIsNone(integers._repr_png_())

    def test_a_view_map_has_the_colours_of_its_directions(self):
        picture = self.field.view_map(7, rows=6)
        self.assertEqual((picture.shape, picture.dtype), ((6, 12, 3), np.uint8))
        sine, azimuth = 1 - 5 / 6, np.pi * (8.5 / 6 - 1)  # of row 2, column 8
        along = [np.sqrt(1 - sine**2) * np.cos(azimuth), np.sqrt(1 - sine**2) * np.sin(azimuth), sine]
        wanted = np.clip(np.rint(self.field.radiance(7, along)), 0, 255)
        self.assertEqual(picture[2, 8].tolist(), wanted.tolist())
        with self.assertRaises(IndexError):
            self.field.view_map(len(self.field))
        with self.assertRaises(slf.ArgumentError):
            self.field.view_map(0, rows=0)

    def test_a_turntable_is_a_slider_over_its_pictures(self):
        table = self.field.turntable(4, size=(40, 30))
        page = table._repr_html_()
        shown = [pixels(base64.b64decode(data)) for data in re.findall(r'base64,([^"]+)"', page)]
        self.assertEqual(len(shown), 4)
        for picture, wanted in zip(shown, table.pictures):
            self.assertTrue(np.array_equal(picture, wanted))
        self.assertEqual(page.count(' hidden>'), 3)
        self.assertIn('max="3"', page)

    def test_pickled_fields_come_back(self):
        for field in [self.field, slf.read(memoryview(stream('frames-levels')), levels=3),
                      slf.frames(stream('frames-levels'), levels=3)[2]]:
            again = pickle.loads(pickle.dumps(field))
            self.assertTrue(np.array_equal(again.components, field.components))
            self.assertEqual((again.header, again.frame), (field.header, field.frame))
        frames = pickle.loads(pickle.dumps(slf.frames(io.BytesIO(stream('frames-levels')))))
        self.assertEqual(len(frames), 3)


if __name__ == '__main__':
    unittest.main()
