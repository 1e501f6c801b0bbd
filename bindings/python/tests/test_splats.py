# SPDX-License-Identifier: Apache-2.0
"""Gaussian splats and quality layers: what a file says of them, and arrays of splats alone."""
import os
import pathlib
import pickle
import struct
import subprocess
import tempfile
import unittest
import warnings

import numpy as np

import slf
from test_slf import disc

PROGRAM = os.environ.get('SLF_PROGRAM')
NAMES = 'x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3'.split()


def coded(splats):
    """The bytes of an .slf file of rows as a PLY has them."""
    with tempfile.TemporaryDirectory() as directory:
        ply, made = pathlib.Path(directory) / 'x.ply', pathlib.Path(directory) / 'x.slf'
        header = f'ply\nformat binary_little_endian 1.0\nelement vertex {len(splats)}\n'
        header += ''.join(f'property float {name}\n' for name in NAMES) + 'end_header\n'
        ply.write_bytes(header.encode() + b''.join(struct.pack('<14f', *row) for row in splats))
        subprocess.run([PROGRAM, 'encode', ply, '-o', made, '--quality', '0.5', '--quiet'], check=True)
        return made.read_bytes()


@unittest.skipUnless(PROGRAM, 'SLF_PROGRAM: the program is not named')
class SplatsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        half = np.sqrt(0.5)  # of a turn by 90 degrees about z: axis 0 to y
        cls.field = slf.read(coded([[-0.5, 0, 0, 1.7, -1.7, -1.7, 2, -1, -2, -3, 1, 0, 0, 0],
                                    [0.5, 0, 0, 1.7, -1.7, -1.7, -1, -1, -2, -3, half, 0, 0, half]]))

    def test_a_file_of_splats_says_so(self):
        self.assertTrue(self.field.has_splats)
        self.assertTrue(self.field.header.has_splats)

    def test_opacities_and_covariances_are_those_of_the_splats(self):
        first = int(np.argmin(self.field.points[:, 0]))
        order = [first, 1 - first]
        opacities, covariances = self.field.opacities[order], self.field.covariances[order]
        self.assertEqual((opacities.shape, opacities.dtype), ((2,), np.float32))
        self.assertEqual((covariances.shape, covariances.dtype), ((2, 3, 3), np.float32))
        np.testing.assert_allclose(opacities, 1 / (1 + np.exp([-2, 1])), atol=0.01)  # of a step of Q 0.5
        variances = np.exp([-2, -4, -6])
        for covariance, wanted in zip(covariances, (variances, variances[[1, 0, 2]])):
            np.testing.assert_array_equal(covariance, covariance.T)
            np.testing.assert_allclose(covariance, np.diag(wanted), atol=0.03 * variances[0])
        self.assertFalse(self.field.opacities.flags.writeable or self.field.covariances.flags.writeable)

    def test_arrays_of_discs_warn_of_splats_and_colours_do_not(self):
        for name in ('normals', 'radii'):
            with self.assertWarnsRegex(FutureWarning, f'{name} are of discs, .* covariances') as caught:
                getattr(pickle.loads(pickle.dumps(self.field)), name)
            self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            self.assertEqual(self.field.mean_colours.shape, (2, 3))


class DiscsTest(unittest.TestCase):
    def test_a_field_without_splats_has_no_arrays_of_them(self):
        field = slf.read(slf.encode(disc(), q=4, grid_bits=6).data)
        self.assertFalse(field.has_splats or field.header.has_splats)
        for name in ('opacities', 'covariances'):
            with self.assertRaisesRegex(slf.ArgumentError, f'{name} are of splats, and this light field holds none') as caught:
                getattr(field, name)
            self.assertEqual(caught.exception.element, name)
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            self.assertEqual((field.normals.shape, field.radii.shape), ((len(field), 3), (len(field),)))

    def test_headers_count_quality_layers(self):
        for layers in (1, 3):
            data = slf.encode(disc(), q=1, grid_bits=6, quality_layers=layers).data
            self.assertEqual(slf.info(data).layers, layers)
            with self.assertRaisesRegex(slf.ArgumentError, f'^layers of this file are 1 to {layers}; 0 is all$'):
                slf.read(data, layers=4)


if __name__ == '__main__':
    unittest.main()
