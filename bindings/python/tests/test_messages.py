# SPDX-License-Identifier: Apache-2.0
"""What goes wrong is said of the file that it is of, with what would be right; Ctrl-C is heard."""
import pathlib
import signal
import tempfile
import time
import unittest

import numpy as np

import slf
from test_slf import disc


class MessagesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.encoded = slf.encode(disc(), q=1, grid_bits=7)
        cls.field = slf.read(cls.encoded.data)

    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.folder = pathlib.Path(self.directory.name)

    def test_a_file_that_is_no_stream_is_named_and_said_to_be_none(self):
        plain = self.folder / 'plain.ply'
        plain.write_text('ply\nformat ascii 1.0\nend_header\n')
        for function in (slf.read, slf.info, slf.frames):
            with self.assertRaisesRegex(slf.DamagedError, r'plain\.ply: not an \.slf file'):
                function(plain)
        with self.assertRaises(slf.DamagedError) as caught:
            slf.read(plain.read_bytes())
        self.assertEqual(caught.exception.code, 'SLF_NOT_SLF')

    def test_damage_of_a_file_names_the_file_and_keeps_its_place(self):
        cut = self.folder / 'cut.slf'
        cut.write_bytes(self.encoded.data[:30])
        with self.assertRaisesRegex(slf.DamagedError, r'cut\.slf: ') as caught:
            slf.read(cut)
        with self.assertRaises(slf.DamagedError) as of_bytes:
            slf.read(cut.read_bytes())
        for name in ('code', 'element', 'unit', 'bit_offset'):
            self.assertEqual(getattr(caught.exception, name), getattr(of_bytes.exception, name))

    def test_parts_that_a_file_does_not_have_are_refused_with_those_that_it_has(self):
        with self.assertRaisesRegex(ValueError, 'levels is a whole number of 0 to 21, not 99'):
            slf.read(self.encoded.data, levels=99)
        with self.assertRaisesRegex(slf.ArgumentError, 'levels of this file are 1 to 7') as caught:
            slf.read(self.encoded.data, levels=8)
        self.assertEqual(caught.exception.element, 'levels')
        most = self.field.header.groups
        with self.assertRaisesRegex(ValueError, f'groups of this file are 1 to {most}'):
            slf.read(self.encoded.data, groups=most + 1)
        with self.assertRaisesRegex(slf.ArgumentError, 'levels of this file are 1 to 7; 0 is all'):
            slf.frames(self.encoded.data, levels=8)[0]
        with self.assertRaisesRegex(IndexError, 'frame 4 is asked for, but there are 1, from 0 on'):
            slf.frames(self.encoded.data)[4]

    def test_a_picture_needs_a_camera(self):
        with self.assertRaisesRegex(TypeError, 'a Camera is needed, .* not NoneType'):
            self.field.render(None)

    def test_a_write_names_the_path_that_was_given(self):
        for path in (self.folder / 'no' / 'x.slf', self.folder):
            with self.assertRaises(OSError) as caught:
                self.encoded.write(path)
            self.assertEqual(caught.exception.filename, str(path))
            self.assertNotIn('.tmp', str(caught.exception))

    def test_what_the_program_alone_codes_is_said_to_be(self):
        names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2', 'opacity', 'scale_0', 'scale_1', 'scale_2', 'rot_0', 'rot_1', 'rot_2', 'rot_3']
        splats = self.folder / 'splats.ply'
        splats.write_text('ply\nformat ascii 1.0\nelement vertex 1\n' + ''.join(f'property float {name}\n' for name in names) +
                          'end_header\n0 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n')
        with self.assertRaisesRegex(slf.InputError, 'holds Gaussian splats, .* slf encode'):
            slf.encode(splats)
        take = self.folder / 'take'
        take.mkdir()
        for number in (1, 2):
            (take / f'cloud_{number}.ply').write_text('ply\nformat ascii 1.0\nelement vertex 0\nend_header\n')
        with self.assertRaisesRegex(slf.InputError, 'holds frames in time, .* slf encode'):
            slf.encode(take)


class InterruptTest(unittest.TestCase):
    def test_reading_and_the_first_picture_end_when_python_is_interrupted(self):
        random = np.random.default_rng(5)
        where = random.normal(size=(400_000, 3))
        where /= np.linalg.norm(where, axis=1)[:, None]
        colours = random.integers(0, 256, where.shape, np.uint8)
        encoded = slf.encode(slf.Capture(where, normals=where, colours=colours), q=1, grid_bits=12, slice_points=4000)
        begin = time.process_time()
        field = slf.read(encoded.data, threads=1)
        whole = time.process_time() - begin

        def ends_early(function):
            """In less than half of the processor's time that a whole decode takes."""
            handler = signal.signal(signal.SIGPROF, signal.default_int_handler)
            signal.setitimer(signal.ITIMER_PROF, whole / 8)
            try:
                start = time.process_time()
                with self.assertRaises(KeyboardInterrupt):
                    function()
                self.assertLess(time.process_time() - start, whole / 2)
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)
                signal.signal(signal.SIGPROF, handler)
        ends_early(lambda: slf.read(encoded.data, threads=1))
        ends_early(lambda: field.render(field.orbit(0, size=(20, 20))))


if __name__ == '__main__':
    unittest.main()
