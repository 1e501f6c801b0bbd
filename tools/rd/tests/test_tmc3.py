# SPDX-License-Identifier: Apache-2.0
"""The adapter of the G-PCC reference software, with a fake that has its command line."""
import pathlib
import subprocess
import sys

import numpy as np

import frames_tmc3
import one_colour
import tmc3
from tests.scratch import Scratch

FAKE_TMC3 = pathlib.Path(__file__).resolve().parent / "fake_tmc3.py"


def run(words):
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=True).stdout


class Planes(Scratch):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(5)
        self.positions = np.unique(random.integers(0, 32, (60, 3)), axis=0).astype(np.int32)
        random.shuffle(self.positions)
        self.coefficients = random.normal(0, 20, (len(self.positions), 2, 3))
        self.coefficients[:, 1] = 7  # constant planes are not coded

    def code(self, qp):
        return tmc3.code_planes(tmc3.Coder(str(FAKE_TMC3), self.folder / "runs", run), self.positions, self.coefficients, qp)

    def test_fine_planes_come_back_within_half_a_step_in_our_order(self):
        _, decoded, _ = self.code(4)
        step = np.ptp(self.coefficients.reshape(len(self.positions), -1), axis=0).max() / 255
        self.assertLessEqual(np.abs(decoded - self.coefficients).max(), step / 2 + 1e-9)

    def test_bytes_count_the_geometry_once_and_each_planes_attribute_units(self):
        sizes, _, times = self.code(16)
        points = len(self.positions)
        self.assertEqual(sizes["geometry"], (5 + 16) + (5 + 1) + (5 + 12 * points))
        self.assertEqual(sizes["coefficients"], 3 * ((5 + 7) + (5 + 8 + points)))
        self.assertEqual(sizes["parameters"], 4 + 4 * 6)
        self.assertEqual(set(times), {"geometry", "coefficients"})

    def test_a_higher_qp_is_worse(self):
        errors = [np.abs(self.code(qp)[1] - self.coefficients).mean() for qp in (4, 34)]
        self.assertEqual(errors, sorted(errors))

    def test_damaged_streams_are_refused(self):
        with self.assertRaises(ValueError):
            tmc3.units(b"\x02\x00\x00\x00\x09abc")


class Colours(Scratch):
    def test_colours_come_back_in_our_order_and_are_counted_apart(self):
        random = np.random.default_rng(2)
        positions = np.unique(random.integers(0, 16, (40, 3)), axis=0)
        random.shuffle(positions)
        colours = random.integers(0, 256, positions.shape)
        geometry, size, back, _ = one_colour.coded(str(FAKE_TMC3), positions, colours, 22)
        np.testing.assert_array_equal(back, colours)
        self.assertEqual(size, (5 + 7) + (5 + 3 * len(positions)))
        self.assertEqual(geometry, (5 + 16) + (5 + 1) + (5 + 12 * len(positions)))


class Frames(Scratch):
    CURVE = [(4000, 40.0), (1000, 30.0)]

    def test_bytes_between_two_points_are_on_a_line_of_logarithms(self):
        self.assertAlmostEqual(frames_tmc3.bytes_at(self.CURVE, 35), 2000)
        self.assertIsNone(frames_tmc3.bytes_at(self.CURVE, 41))

    def test_half_of_the_bytes_at_equal_decibels_is_half(self):
        self.assertAlmostEqual(frames_tmc3.compared([(1000, 35), (500, 30), (1, 99)], self.CURVE), -0.5)
        self.assertIsNone(frames_tmc3.compared([(1, 99)], self.CURVE))

    def test_another_place_is_no_frame_that_came_back(self):
        places, values = np.array([[1, 2, 3], [4, 5, 6]]), np.array([7, 8])
        decoded = {"x": [4, 1], "y": [5, 2], "z": [6, 3], "reflectance": np.array([8, 5])}
        self.assertAlmostEqual(frames_tmc3.error_of((places, values), decoded), 2)
        with self.assertRaises(SystemExit):
            frames_tmc3.error_of((places + 1, values), decoded)


class Error(Scratch):
    def test_an_error_of_the_constant_function_is_its_square_in_every_direction(self):
        field = {"grid": {"origin": [0, 0, 0], "step": 1}, "gamma_range": [-1, 1], "colour": {"to_rgb": np.eye(3).tolist()},
                 "basis": {"order": 2, "scales_theta": 2, "scales_gamma": 1}}
        error = np.zeros((10, 8, 3))
        error[:, 0] = 3
        positions, centres = np.arange(30).reshape(10, 3), np.array([[50.0, 0, 9], [0, 60, -4]])
        self.assertAlmostEqual(tmc3.mean_square_error(field, positions, error, centres), 9)
        error[:, 5] = 1
        self.assertGreater(tmc3.mean_square_error(field, positions, error, centres), 9)

    def test_squared_errors_add_up(self):
        quality = {"cameras": 2, "points": [{"delta": 10, "psnr": 10 * np.log10(255 ** 2 / 50.0)}], "image": None}
        self.assertAlmostEqual(tmc3.with_error(quality, 150)["points"][0]["psnr"], 10 * np.log10(255 ** 2 / 200.0))
        self.assertIsNone(tmc3.with_error(None, 1))


class Runs(Scratch):
    def test_it_is_a_codec_of_manifests_where_the_program_is_given(self):
        path = self.manifest(codecs=["raht", "tmc3"], rates={"raht": [8], "tmc3": [22]}, grid={"order": [2]})
        code, _, said = self.rd(path, "--tmc3", FAKE_TMC3)
        self.assertEqual(code, 0, said)
        table = (self.folder / "out" / "results.csv").read_text()
        self.assertEqual(table.count(",tmc3,paper,"), 1)
        self.assertEqual(table.count("estimated"), 1)

    def test_a_basis_that_the_estimate_does_not_know_fails_with_the_reason(self):
        path = self.manifest(codecs=["tmc3"], rates={"tmc3": [22]}, grid={"order": [2]}, options={"fit": "hierarchical"})
        code, _, said = self.rd(path, "--tmc3", FAKE_TMC3)
        self.assertEqual(code, 1)
        self.assertIn("1 failed: ValueError: the PSNR of tmc3 is estimated for B-splines of directions of the world alone", said)

    def test_without_the_program_the_others_run(self):
        path = self.manifest(codecs=["raht", "tmc3"], rates={"raht": [8], "tmc3": [10]}, grid={"order": [2]})
        code, _, said = self.rd(path, "--dry-run")
        self.assertEqual(code, 0, said)
        self.assertIn("1 encodes", said)
        self.assertIn("skipped: codec tmc3 (--tmc3)", said)
