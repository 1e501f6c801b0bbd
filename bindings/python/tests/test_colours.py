# SPDX-License-Identifier: Apache-2.0
"""Colours as other libraries have them, plots, and drawing that an interrupt ends."""
import signal
import sys
import time
import unittest

import numpy as np

import slf
from test_slf import disc


class ColoursTest(unittest.TestCase):
    def encoded(self, colours):
        capture = disc()
        capture.colours = colours
        return slf.encode(capture, q=1, grid_bits=7).data

    def test_floats_of_open3d_and_rgba_of_trimesh_are_the_same_colours(self):
        rgb = disc().colours
        wanted = self.encoded(rgb)
        opaque = np.full((len(rgb), 1), 255, np.uint8)
        for colours in [rgb / 255, (rgb / 255).astype(np.float32), np.hstack([rgb, opaque]),
                        np.hstack([rgb, opaque]) / 255, rgb.astype(np.int64)]:
            self.assertEqual(self.encoded(colours), wanted)

    def test_floats_that_are_no_fractions_are_refused(self):
        rgb = disc().colours
        for wrong in (rgb.astype(float), rgb / 255 + 0.5, -(rgb / 255), np.full(rgb.shape, np.nan)):
            with self.assertRaisesRegex(slf.ArgumentError, 'colours'):
                self.encoded(wrong)
        with self.assertRaises(ValueError):
            self.encoded(rgb[:, :2])


class PlotTest(unittest.TestCase):
    def test_a_view_map_is_drawn_into_axes(self):
        field = slf.read(slf.encode(disc(), q=2, grid_bits=6).data)
        try:
            import matplotlib
        except ImportError:
            self.skipTest('matplotlib is not installed')
        matplotlib.use('agg')
        ax = field.plot_view_map(3, rows=8)
        self.assertTrue(np.array_equal(ax.images[0].get_array(), field.view_map(3, rows=8)))
        self.assertIn('azimuth', ax.get_xlabel())
        self.assertIs(field.plot_view_map(4, ax=ax), ax)
        self.assertEqual(ax.get_title(), 'point 4')
        with self.assertRaises(IndexError):
            field.plot_view_map(len(field))


class InterruptTest(unittest.TestCase):
    @unittest.skipIf(sys.platform == 'win32', 'no interval timers')
    def test_a_long_rendering_hears_an_interrupt(self):
        field = slf.read(slf.encode(disc(30000), q=4, grid_bits=10).data, threads=1)
        camera = slf.Camera.look_at([0, 0, 1.2], [0, 0, 0], up=[0, 1, 0], size=(6000, 4000), fov=70)
        field.render(camera, size=(60, 40))
        began = time.process_time()  # of the processor: other programs do not count
        field.render(camera)
        whole = time.process_time() - began

        def interrupt(number, frame):
            raise KeyboardInterrupt
        before = signal.signal(signal.SIGALRM, interrupt)
        began = time.process_time()
        try:
            signal.setitimer(signal.ITIMER_REAL, whole / 10)
            with self.assertRaises(KeyboardInterrupt):
                field.render(camera)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertLess(time.process_time() - began, 0.5 * whole)
        self.assertEqual(field.render(camera, size=(60, 40)).shape, (40, 60, 3))


if __name__ == '__main__':
    unittest.main()
