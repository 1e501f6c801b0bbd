# SPDX-License-Identifier: Apache-2.0
"""RAHT-KLT of the laboratory: its own promises."""
import unittest

import numpy as np

from raht_klt import RahtKlt, Rlgr, merges, morton, raht


def cloud(points=500, views=5):
    random = np.random.default_rng(1)
    positions = np.unique(random.integers(0, 32, (points, 3)), axis=0)
    smooth = positions.sum(1)[:, None, None] + 5 * np.arange(views)[None, :, None] + np.array([0, 20, 60])
    return positions, np.clip(smooth + random.integers(-2, 3, smooth.shape), 0, 255).astype(np.uint8)


class RahtKltTest(unittest.TestCase):
    def test_transform_is_orthonormal(self):
        positions, colours = cloud()
        steps = merges(np.sort(morton(positions)))
        values = colours[:, :, 0].astype(float)
        there = raht(values.copy(), steps)
        self.assertAlmostEqual((there ** 2).sum() / (values ** 2).sum(), 1, places=9)
        self.assertLess(abs(raht(there, steps, inverse=True) - values).max(), 1e-9)

    def test_without_a_step_every_byte_comes_back(self):
        positions, colours = cloud()
        bits, back = RahtKlt(positions, colours).coded(0)
        np.testing.assert_array_equal(back, colours)

    def test_a_larger_step_has_fewer_bits_and_more_error(self):
        positions, colours = cloud()
        codec = RahtKlt(positions, colours)
        coded = [codec.coded(step) for step in (1, 4, 16)]
        errors = [float(((back.astype(float) - colours) ** 2).mean()) for _, back in coded]
        self.assertEqual(sorted(errors), errors)
        self.assertEqual(sorted((bits for bits, _ in coded), reverse=True), [bits for bits, _ in coded])

    def test_runs_of_zeros_cost_little(self):
        self.assertLess(Rlgr().code(np.zeros(100000, np.int32)), 100)
        self.assertGreater(Rlgr().code(np.full(1000, 40, np.int32)), 5000)


if __name__ == "__main__":
    unittest.main()
