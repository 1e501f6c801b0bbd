# SPDX-License-Identifier: Apache-2.0
"""Shares of voxels of the laboratory's moving clouds: zero motion and blocks."""
import unittest

import numpy as np

from moving import BLOCK, REACH, shares


def layer(seed=3):
    """A rough surface over 48 x 48 columns; the same for a seed."""
    x, y = np.meshgrid(np.arange(48), np.arange(48), indexing='ij')
    z = np.random.default_rng(seed).integers(20, 28, x.shape)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


class SharesTest(unittest.TestCase):
    def test_a_frame_has_all_of_itself(self):
        self.assertEqual(shares(layer(), layer()), (1, 1))

    def test_one_vector_finds_what_moved_as_a_whole(self):
        zero, block = shares(layer(), layer() + [0, 0, REACH])
        self.assertLess(zero, 0.2)
        self.assertEqual(block, 1)

    def test_a_vector_reaches_no_further_and_nothing_is_beyond_the_edges(self):
        self.assertLess(shares(layer(), layer() + [0, 0, REACH + 8])[1], 0.5)
        self.assertEqual(shares(np.array([[0, 0, 0]]), np.array([[255, 255, 255]])), (0, 0))

    def test_each_block_has_its_own_vector(self):
        before = layer()
        now = before.copy()
        now[:, 2] += np.where(now[:, 0] < BLOCK, 2, -2)
        self.assertEqual(shares(before, now)[1], 1)


if __name__ == '__main__':
    unittest.main()
