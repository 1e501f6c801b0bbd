# SPDX-License-Identifier: Apache-2.0
"""tools/captures/draw_capture.py, where Blender is: a small capture whose cameras, pictures and points agree."""
import unittest

import numpy as np

import judge
from tests import blender
from tests.scratch import Scratch
from tmc3 import read_ply


@blender.needed
class DrawnCapture(Scratch):
    def test_points_lie_where_pictures_show_the_object_to_less_than_a_pixel(self):
        done = blender.run("draw_capture.py", self.folder, "--size", 64, "--cameras", 9, "--samples", 2, "--points", 8000, "--threads", 1)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        capture = judge.Capture(self.folder)
        self.assertEqual(capture.held_out, ["images/0004.png", "images/0008.png"])
        np.testing.assert_allclose((capture.normals ** 2).sum(1), 1, atol=1e-5)
        differ = dict.fromkeys(((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)), 0)
        for name in capture.cameras:
            photograph, shown, background = capture.photograph(name)
            self.assertEqual(background.tolist(), [128, 128, 128])
            for shift in differ:
                differ[shift] += int((np.roll(shown, shift, (0, 1)) != (np.abs(photograph - 128).max(2) > 4)).sum())
        agreed = differ.pop((0, 0))
        self.assertLess(agreed, 0.75 * min(differ.values()), differ)
        sparse = read_ply(self.folder / "sparse_points.ply")
        self.assertAlmostEqual(len(sparse["x"]) / len(capture.positions), 0.03, 2)
        self.assertNotIn("nx", sparse)

    def test_an_option_out_of_range_is_refused(self):
        done = blender.run("draw_capture.py", self.folder / "none", "--size", 3)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--size: a number 16 to 4096 is expected", done.stderr)
        self.assertFalse((self.folder / "none").exists())


if __name__ == "__main__":
    unittest.main()
