# SPDX-License-Identifier: Apache-2.0
"""Wrong arguments are refused by name; nothing is rounded, cut or left out."""
import dataclasses
import os
import pathlib
import tempfile
import threading
import unittest
import unittest.mock

import numpy as np

import slf
from slf import _slf
from test_slf import disc


class ArgumentsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.encoded = slf.encode(disc(), q=1, grid_bits=7)
        cls.field = slf.read(cls.encoded.data)
        cls.camera = slf.Camera.look_at([0, 0, 4], [0, 0, 0], up=[0, 1, 0], size=(16, 16), fov=40)

    def refused(self, name, function, *arguments, **named):
        with self.assertRaises(ValueError) as caught:
            function(*arguments, **named)
        self.assertIn(name, str(caught.exception))
        self.assertLess(len(str(caught.exception)), 200)

    def test_pictures_have_the_memory_limit_that_was_read_with(self):
        roomy = slf.read(self.encoded.data, max_memory=2**40)
        with unittest.mock.patch.object(_slf, 'Renderer', wraps=_slf.Renderer) as made:
            roomy.render(self.camera)
        self.assertEqual(made.call_args.kwargs['max_memory'], 2**40)
        with self.assertRaises(slf.LimitError):
            _slf.Renderer(self.encoded.data, **{**made.call_args.kwargs, 'max_memory': 1000})

    def test_objects_without_contents_are_type_errors(self):
        for cls, method, arguments in ((_slf.Field, 'positions', ()), (_slf.Field, 'info', ()),
                                       (_slf.Field, 'radiance', ([0], [0.0, 0.0, 1.0])),
                                       (_slf.Frames, 'count', ()), (_slf.FramePictures, 'renderer', (0,)),
                                       (_slf.Renderer, 'orbit', (0.0, 60.0, 8, 8, 40.0))):
            with self.subTest(cls.__name__ + '.' + method):
                with self.assertRaisesRegex(TypeError, 'without its contents'):
                    getattr(cls.__new__(cls), method)(*arguments)
                with self.assertRaisesRegex(TypeError, 'self is no ' + cls.__name__):
                    getattr(cls, method)(7, *arguments)

    def test_reading_names_what_is_no_whole_number(self):
        for name in ('levels', 'groups', 'layers', 'max_bytes', 'threads', 'max_memory'):
            for wrong in (-1, 1.5, '1', None, 2**64):
                self.refused(name, slf.read, self.encoded.data, **{name: wrong})
        self.assertLess(len(slf.read(self.encoded.data, levels=np.int64(4))), len(self.field))

    def test_encoding_names_what_is_out_of_type_or_range(self):
        for name, wrong in [
                ('q', 'a'), ('q', 0), ('q', float('nan')), ('quality_loss', 0), ('quality_loss', 11), ('effort', 1.5), ('effort', 'a'), ('effort', 9),
                ('preset', 'best'), ('target_bytes', -5), ('target_psnr', float('inf')),
                ('target_psnr', 'a'), ('grid_bits', 7.5), ('voxel_size', -1), ('normal_bits', 3),
                ('normal_bits', 13), ('quality_layers', 2.5), ('threads', -1)]:
            self.refused(name, slf.encode, disc(), **{name: wrong})
        self.refused('grid_bits', slf.encode, disc(), grid_bits=9, voxel_size=0.1)
        self.refused('colour_space', slf.encode, disc(), colour_space='srgb')
        self.refused('quality_loss', slf.encode, disc(), q=4, quality_loss=0.1)
        self.refused('quality_loss', slf.encode, disc(), preset='paper', quality_loss=0.1)
        self.refused('points', slf.encode, slf.Capture([['a', 'b', 'c']]))

    def test_encoding_takes_every_setting_of_the_program(self):
        table = slf.settings()
        for name in ('surface', 'effort', 'block_strength', 'texture_bits', 'penalise_dc'):
            self.assertIn(name, table)
        for name, row in table.items():
            if name in ('splats', 'surface_seconds', 'surface_memory', 'photograph_pixels'):
                self.refused(f'{name} is for photographs', slf.encode, disc(40), **{name: row['initial'] or int(row['low'])})
            elif row['initial'] and not row['flag'] and not name.startswith(('texture', 'lambda', 'beta', 'iterations', 'functions', 'order')):
                slf.encode(disc(40), **{'grid_bits': 5, name: row['initial']})
        fine, coarse = (slf.encode(disc(), q=1, grid_bits=7, klt=klt) for klt in ('off', 'joint'))
        self.assertNotEqual(fine.data, coarse.data)

    def test_colours_images_and_steps_of_other_types_are_not_cast(self):
        grey = np.full((16, 16, 3), 200, np.uint8)
        for image in (grey / 255, grey.astype(np.uint16) * 256, grey > 100, grey.astype(int) - 300):
            capture = disc()
            capture.cameras, capture.images = [self.camera], [image]
            self.refused('images', slf.encode, capture, split='all')
        colours = disc().colours
        for given in (colours.astype(float), colours.astype(int) + 200, colours > 100):
            self.refused('colours', slf.encode, dataclasses.replace(disc(), colours=given))
        same = dataclasses.replace(disc(), colours=colours.astype(int).tolist())
        self.assertEqual(slf.encode(same, q=1, grid_bits=7).data, self.encoded.data)
        for step in (1.9, 2**32 + 1, -1, True):
            self.refused('steps', slf.pack, [[0, 0, 0], [1, 2, 3]], np.zeros((2, 1, 3), int),
                         steps=np.full((1, 3), step))

    def test_what_is_no_pinhole_camera_is_refused(self):
        k, r = np.asarray(self.camera.K), np.asarray(self.camera.R)
        for rotation in (0 * r, 5 * r, -r):
            self.refused('R', self.field.render, dataclasses.replace(self.camera, R=rotation))
        skewed = k + [[0, 5, 0], [0, 0, 0], [0, 0, 0]]
        for matrix in (skewed, 2 * k, k[:2], 'abc'):
            self.refused('K', self.field.render, dataclasses.replace(self.camera, K=matrix))
        float_digits = dataclasses.replace(self.camera, R=r.astype(np.float32))
        self.assertTrue((self.field.render(float_digits) != 128).any())

    def test_sides_of_pictures_are_whole_numbers(self):
        for size in ((64.5, 48), (0, 48), (48, 64.5), (48, 20000)):
            name = 'width' if size[1] == 48 else 'height'
            self.refused(name, self.camera.resized, size)
            self.refused(name, self.field.render, self.camera, size)
            self.refused(name, self.field.orbit, 0.1, size=size)
        self.refused('width', self.field.render, dataclasses.replace(self.camera, width=16.5))


class EncodedTest(unittest.TestCase):
    def test_writers_of_one_path_do_not_disturb_each_other(self):
        encoded = slf.encode(disc(60), q=4, grid_bits=5)
        failures = []
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'

            def write_often():
                try:
                    for _ in range(200):
                        encoded.write(path)
                except OSError as error:
                    failures.append(error)
            threads = [threading.Thread(target=write_often) for _ in range(2)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(failures, [])
            self.assertEqual(os.listdir(directory), ['x.slf'])
            self.assertEqual(path.read_bytes(), encoded.data)

    def test_a_failed_write_leaves_no_file(self):
        encoded = slf.encode(disc(60), q=4, grid_bits=5)
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'
            path.mkdir()
            with self.assertRaises(OSError):
                encoded.write(path)
            self.assertEqual(os.listdir(directory), ['x.slf'])

    def test_the_stream_is_not_printed(self):
        encoded = slf.encode(disc(), q=1, grid_bits=7)
        self.assertLess(len(repr(encoded)), 300)
        self.assertIn('q=1', repr(encoded))

    def test_cameras_can_be_looked_for_in_lists(self):
        one, other = (slf.Camera.look_at((3, 0, z), (0, 0, 0)) for z in (0, 1))
        self.assertEqual(one, one)
        self.assertNotIn(one, [other])
        self.assertIn(one, [other, one])


if __name__ == '__main__':
    unittest.main()
