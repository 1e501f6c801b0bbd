# SPDX-License-Identifier: Apache-2.0
"""Where reading begins, and what a light field keeps of its source."""
import contextlib
import io
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import slf
from slf import _ranges
from test_ranges import dense, served

PARTS = ({'levels': 4}, {'max_bytes': 3000}, {'region': ((0, 0, 0), (1, 1, 1))}, {'levels': 7}, {'groups': 1}, {'layers': 1})


class NoSeek(io.RawIOBase):
    """A pipe: read once, from where it stands."""

    def __init__(self, data):
        self.file = io.BytesIO(data)

    def readable(self):
        return True

    def readinto(self, to):
        return self.file.readinto(to)


class OldTemporary:
    """Can be sought in and does not say so, as temporary files of Python before 3.11."""

    def __init__(self, data):
        file = io.BytesIO(data)
        self.read, self.seek, self.tell = file.read, file.seek, file.tell


class WhereTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = dense(4000)

    def uses(self):
        return {'info': slf.info, 'read': slf.read, 'part': lambda file: slf.read(file, levels=3), 'frames': slf.frames,
                'truncate': lambda file: slf.truncate(file, levels=3), 'annotate': lambda file: slf.annotate(file, metres_per_unit=2)}

    def test_an_open_file_is_read_from_its_beginning_and_stands_where_it_stood(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'
            path.write_bytes(self.data)
            with path.open('rb') as file, open(path, 'rb', buffering=0) as raw, tempfile.SpooledTemporaryFile() as spooled:
                spooled.write(self.data)
                for opened in (file, raw, spooled, io.BytesIO(self.data), OldTemporary(self.data)):
                    for stood in (0, 7, len(self.data)):
                        opened.seek(stood)
                        for name, use in self.uses().items():
                            with self.subTest(type(opened).__name__, use=name, stood=stood):
                                use(opened)
                                self.assertEqual(opened.tell(), stood)

    def test_a_file_that_is_refused_stands_where_it_stood(self):
        for use in self.uses().values():
            file = io.BytesIO(b'no stream')
            file.seek(4)
            with self.assertRaises(slf.DamagedError):
                use(file)
            self.assertEqual(file.tell(), 4)

    def test_what_cannot_be_sought_in_is_read_from_where_it_stands(self):
        for name, use in self.uses().items():
            with self.subTest(name):
                pipe = NoSeek(b'head' + self.data)
                pipe.read(4)
                use(pipe)

    def test_text_is_no_stream(self):
        for use in self.uses().values():
            with self.assertRaisesRegex(TypeError, 'a binary file'):
                use(io.StringIO('text'))


class KeptTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = dense(4000)
        cls.other = dense(4000, seed=6)

    def expect_whole(self, field, **part):
        """All that decodes once more, from a source that is gone."""
        wanted = slf.read(self.data, **part)
        camera = wanted.orbit(0.1, size=(40, 40))
        self.assertTrue(np.array_equal(field.render(camera), wanted.render(camera)))
        self.assertEqual(field._repr_png_(), wanted._repr_png_())
        again = pickle.loads(pickle.dumps(field))
        self.assertTrue(np.array_equal(again.components, wanted.components))
        self.assertTrue(np.array_equal(again.render(camera), wanted.render(camera)))

    def test_a_part_of_a_file_that_is_closed_is_drawn_and_pickled(self):
        for part in PARTS:
            with self.subTest(part), tempfile.TemporaryFile() as file:
                file.write(self.data)
                field = slf.read(file, **part)
            self.expect_whole(field, **part)

    def test_a_part_of_a_path_that_is_deleted_or_another_file_by_now_is_drawn_and_pickled(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'
            for meanwhile in (path.unlink, lambda: path.write_bytes(self.other)):
                path.write_bytes(self.data)
                field = slf.read(path, levels=4)
                meanwhile()
                self.expect_whole(field, levels=4)

    def test_a_part_of_an_address_is_not_fetched_twice(self):
        short, _ranges._FIRST = _ranges._FIRST, 512
        self.addCleanup(setattr, _ranges, '_FIRST', short)
        with served(self.data) as (address, asked):
            field = slf.read(address, levels=4)
            times = len(asked)
            self.expect_whole(field, levels=4)
            self.assertEqual(len(asked), times)

    def test_a_pickle_has_no_more_than_was_read(self):
        data = dense(60000)
        self.assertLess(len(pickle.dumps(slf.read(io.BytesIO(data), levels=5))), 0.75 * len(data))

    def test_a_file_that_shrinks_while_it_is_read_is_named(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'
            path.write_bytes(self.data)
            with path.open('rb') as file, contextlib.ExitStack() as stack:
                size = _ranges.FileRanges(file).size
                kept = _ranges.KeptRanges(_ranges.FileRanges(file))
                stack.callback(kept.close)
                os.truncate(path, size // 2)
                with self.assertRaisesRegex(OSError, rf'x\.slf: ended at byte {size // 2} while it was read'):
                    kept.read_at(0, size)
            with self.assertRaisesRegex(OSError, r'x\.slf: bytes 0 to 9 were not read'):
                kept.read_at(0, 10)


class PiecesTest(unittest.TestCase):
    def test_pieces_that_meet_or_overlap_are_one(self):
        random = np.random.default_rng(1)
        data = random.integers(0, 256, 200, np.uint8).tobytes()
        for _ in range(200):
            kept, known = _ranges.KeptRanges(_ranges.FileRanges(io.BytesIO(data))), np.zeros(200, bool)
            for _ in range(12):
                begin = int(random.integers(0, 199))
                size = int(random.integers(1, 201 - begin))
                self.assertEqual(kept.read_at(begin, size), data[begin:begin + size])
                known[begin:begin + size] = True
            kept.close()
            for begin in range(0, 190, 7):
                if known[begin:begin + 10].all():
                    self.assertEqual(kept.read_at(begin, 10), data[begin:begin + 10])
                else:
                    self.assertRaises(OSError, kept.read_at, begin, 10)


if __name__ == '__main__':
    unittest.main()
