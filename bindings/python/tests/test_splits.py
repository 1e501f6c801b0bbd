# SPDX-License-Identifier: Apache-2.0
"""A file says which photographs it was made from; what is for photographs is refused of a cloud alone."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import slf
from test_files import photographed
from test_slf import disc

PROGRAM = os.environ.get('SLF_PROGRAM')
QUICK = {'q': 4, 'grid_bits': 6, 'effort': 1, 'surface': 'given'}


class SplitTest(unittest.TestCase):
    def test_what_was_input_is_not_held_out(self):
        capture = photographed()
        for split, recorded, cameras in (('all', 'all', (8, None)), ('1/2', '1/2', (3, 2)), ('', 'default', (6, 2))):
            data = slf.encode(capture, split=split, **QUICK).data
            self.assertEqual(dict(slf.info(data).metadata)['split'], recorded)
            measured = slf.eval(data, capture, images=False)
            held_out = None if measured.held_out is None else measured.held_out.cameras
            # Every fourth is for evaluation, and 1/2 takes every other of the rest.
            self.assertEqual((measured.input.cameras, held_out), cameras, split)

    def test_a_cloud_has_no_split(self):
        self.assertNotIn('split', dict(slf.info(slf.encode(disc(), q=4, grid_bits=6).data).metadata))
        with self.assertRaisesRegex(slf.ArgumentError, '^split 1/2: the capture has no cameras$') as caught:
            slf.encode(disc(), split='1/2')
        self.assertEqual(caught.exception.element, 'split')

    @unittest.skipUnless(PROGRAM, 'SLF_PROGRAM: the program is not named')
    def test_the_program_makes_the_same_file_of_a_directory(self):
        with tempfile.TemporaryDirectory() as directory:
            capture, coded = pathlib.Path(directory) / 'small can', pathlib.Path(directory) / 'x.slf'
            subprocess.run([PROGRAM, 'synth', 'can', '-o', capture, '--size', '32x32', '--points', '400', '--circles', '2',
                            '--per-circle', '6', '--quiet'], check=True)
            for split in ('', '1/2'):
                subprocess.run([PROGRAM, 'encode', capture, '-o', coded, '--quality', '4', '--grid-bits', '6', '--effort', '1',
                                '--surface', 'given', '--quiet', *(['--split', split] if split else [])], check=True)
                data = slf.encode(f'{capture}/', split=split, **QUICK).data
                self.assertEqual(dict(slf.info(data).metadata)['source'], 'small can')
                self.assertEqual(slf.info(data), slf.info(coded))
                self.assertEqual(data, coded.read_bytes())


class PhotographsTest(unittest.TestCase):
    def test_settings_for_photographs_are_refused_of_a_cloud(self):
        for name, value in (('surface', 'splats'), ('surface', 'mended'), ('surface', 'trained'), ('match_exposure', True),
                            ('refine_cameras', 'on'), ('splats', 300), ('surface_seconds', 3), ('surface_memory', 64),
                            ('photograph_pixels', 1)):
            with self.assertRaisesRegex(slf.ArgumentError, f'^{name}.* is for photographs, and the capture has none$') as caught:
                slf.encode(disc(), **{name: value})
            self.assertEqual(caught.exception.element, name)
        for surface in ('given', 'auto'):
            slf.encode(disc(), q=4, grid_bits=6, surface=surface, match_exposure='auto')


if __name__ == '__main__':
    unittest.main()
