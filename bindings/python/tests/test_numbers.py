# SPDX-License-Identifier: Apache-2.0
"""Numbers of numpy are taken wherever a number is; those out of range are refused by name, with the range."""
import dataclasses
import unittest

import numpy as np

import slf
from test_files import PageTest, photographed
from test_slf import disc


class NumbersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = slf.encode(disc(), q=2, grid_bits=6).data
        cls.field = slf.read(cls.data)

    def page(self, **given):
        return PageTest().page(self.data, poster=False, **given)

    def test_pages_take_numbers_of_numpy(self):
        usual = self.page(speed=2, autorotate=3, azimuth=40, elevation=10, fov=20, metres_per_unit=0.5)
        for kind in (np.float32, np.float64, np.float16, np.longdouble, np.array):
            self.assertEqual(self.page(speed=kind(2.0), autorotate=kind(3.0), azimuth=kind(40.0), elevation=kind(10.0),
                                       fov=kind(20.0), metres_per_unit=kind(0.5)).replace('.0,', ',').replace('.0}', '}'),
                             usual.replace('.0,', ',').replace('.0}', '}'))
        self.assertEqual(self.page(speed=np.int64(2), autorotate=np.uint8(3), azimuth=np.int8(40), elevation=np.array(10),
                                   fov=np.int16(20), metres_per_unit=np.float32(0.5)), usual)
        camera = self.field.orbit(0)
        given = dataclasses.replace(camera, width=np.int64(800), height=np.int32(800), K=np.asarray(camera.K, np.float32))
        self.assertIn('"width": 800', self.page(camera=given))
        with self.assertRaisesRegex(TypeError, 'a Camera is needed'):
            self.page(camera=3)

    def test_notes_take_numbers_of_numpy(self):
        notes = {'version': np.int64(1), 'annotations': [{'at': np.zeros(3, np.float32), 'title': 'Rim'},
                                                         {'at': [np.float32(1), np.int8(0), 0], 'title': 'Foot'}]}
        plain = {'version': 1, 'annotations': [{'at': [0.0, 0.0, 0.0], 'title': 'Rim'}, {'at': [1.0, 0, 0], 'title': 'Foot'}]}
        self.assertEqual(slf.annotate(self.data, notes=notes), slf.annotate(self.data, notes=plain))
        self.assertEqual(slf.encode(disc(), q=2, notes=notes).data, slf.encode(disc(), q=2, notes=plain).data)
        with self.assertRaisesRegex(TypeError, 'notes: set'):
            slf.annotate(self.data, notes={'version': {1}})

    def test_files_take_numbers_of_numpy(self):
        self.assertEqual(slf.export(self.data, size=np.float32(1), degree=np.int64(1)), slf.export(self.data, size=1, degree=1))
        self.assertEqual(slf.annotate(self.data, metres_per_unit=np.float32(2)), slf.annotate(self.data, metres_per_unit=2))
        self.assertEqual(slf.truncate(self.data, levels=np.array(4)), slf.truncate(self.data, levels=4))
        for wrong in (-1, '1', np.nan):
            with self.assertRaisesRegex(slf.ArgumentError, 'metres_per_unit is a number of 0 to'):
                slf.annotate(self.data, metres_per_unit=wrong)

    def test_encoding_takes_numbers_of_numpy(self):
        usual = slf.encode(disc(), q=2.5, grid_bits=6, threads=1, predict=True).data
        for q in (np.float32(2.5), np.array(2.5)):
            self.assertEqual(slf.encode(disc(), q=q, grid_bits=np.array(6), threads=np.int8(1), predict=np.bool_(True)).data, usual)
        four = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 6, 7]])
        self.assertEqual(slf.pack(four, bits=np.int64(4), origin=np.array([1, 2, 3], np.float32), step=np.float32(0.5)),
                         slf.pack(four, bits=4, origin=(1, 2, 3), step=0.5))
        for wrong, name in (({'origin': (1, 2)}, 'origin is three numbers'), ({'origin': (1, 2, np.nan)}, 'origin is a number, not'),
                            ({'step': '1'}, 'step is a number, not')):
            with self.assertRaisesRegex(slf.ArgumentError, name):
                slf.pack(four, **wrong)

    def test_quality_takes_numbers_of_numpy(self):
        measured = slf.eval(self.data, photographed(), deltas=np.array([10, 60], np.float32), images=np.bool_(False))
        self.assertEqual([p.delta for p in measured.input.points], [10, 60])

    def test_cameras_take_numbers_of_numpy_and_refuse_what_is_none(self):
        eye, target, size = (3, 0, 0), (0, 0, 0), (np.int64(40), np.uint16(30))
        one = slf.Camera.look_at(eye, target, size=size, fov=np.float32(40))
        other = slf.Camera.look_at(eye, target, size=(40, 30), fov=40)
        self.assertTrue(np.array_equal(one.K, other.K))
        self.assertTrue(np.array_equal(self.field.orbit(np.float32(0.25), np.int8(20), size, np.array(30)).R,
                                       self.field.orbit(0.25, 20, (40, 30), 30).R))
        self.assertEqual(self.field.render(one, view_dependent=np.bool_(False)).shape, (30, 40, 3))
        for fov in (0, 180, 400, -30, np.nan, 'wide', None):
            for make in (lambda: slf.Camera.look_at(eye, target, fov=fov), lambda: self.field.orbit(0, fov=fov)):
                with self.assertRaisesRegex(slf.ArgumentError, 'fov is a number of 1 to 170, not'):
                    make()
        for turn in (np.nan, np.inf, 'a'):
            with self.assertRaisesRegex(slf.ArgumentError, 'turn is a number, not'):
                self.field.orbit(turn)
        with self.assertRaisesRegex(slf.ArgumentError, 'elevation is a number of -90 to 90, not 1000'):
            self.field.orbit(0, 1000)
        with self.assertRaisesRegex(slf.ArgumentError, 'size is width and height, not 60'):
            self.field.render(one, 60)

    def test_an_axis_that_is_none_is_told_those_that_are(self):
        for up in ('y', 2):
            with self.assertRaisesRegex(slf.ArgumentError, r'up is \+x, -x, \+y, -y, \+z, -z, unknown, not') as caught:
                slf.encode(dataclasses.replace(disc(), up=up))
            self.assertEqual(caught.exception.element, 'up')


if __name__ == '__main__':
    unittest.main()
