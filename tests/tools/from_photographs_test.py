#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/capture/from_photographs.sh, with a program in COLMAP's place: what it finds, what it refuses, where it goes on.

    tests/tools/from_photographs_test.py ROOT SLF
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT, SLF = pathlib.Path(sys.argv[1]), sys.argv[2]
SCRIPT = ROOT / 'tools/capture/from_photographs.sh'
ENCODE = ['--', '--grid-bits', '5', '--effort', '1', '--surface', 'given', '-q', '32', '--quiet']
# It writes down what it was asked for, and its mapper leaves the model that the test has made.
COLMAP = '''#!/bin/bash
echo "$1" >>"$FAKE/asked"
[ "$1" != mapper ] || { while [ "$1" != --output_path ]; do shift; done; [ ! -d "$FAKE/model" ] || cp -r "$FAKE/model" "$2/0"; }
'''


def quaternion(r):
    """w x y z of a rotation: the largest of the four has a divisor that is not small."""
    four = [1 + r[0][0] + r[1][1] + r[2][2], 1 + r[0][0] - r[1][1] - r[2][2], 1 - r[0][0] + r[1][1] - r[2][2],
            1 - r[0][0] - r[1][1] + r[2][2]]
    most = four.index(max(four))
    d = 2 * four[most] ** 0.5
    pairs = {(0, 1): r[2][1] - r[1][2], (0, 2): r[0][2] - r[2][0], (0, 3): r[1][0] - r[0][1], (1, 2): r[1][0] + r[0][1],
             (1, 3): r[0][2] + r[2][0], (2, 3): r[2][1] + r[1][2]}
    return [d / 4 if k == most else pairs[min(k, most), max(k, most)] / d for k in range(4)]


def write_model(capture, folder):
    """The cameras of a capture as a COLMAP model in text, without points."""
    cameras = json.loads((capture / 'cameras.json').read_text())['cameras']
    folder.mkdir(parents=True)
    k = cameras[0]['K']
    (folder / 'cameras.txt').write_text(
        f"1 PINHOLE {cameras[0]['width']} {cameras[0]['height']} {k[0][0]} {k[1][1]} {k[0][2]} {k[1][2]}\n")
    lines = []
    for i, camera in enumerate(cameras):
        numbers = [*quaternion(camera['R']), *camera['t']]
        lines.append(f"{i + 1} {' '.join(map(str, numbers))} 1 {pathlib.Path(camera['image']).name}\n\n")
    (folder / 'images.txt').write_text(''.join(lines))
    (folder / 'points3D.txt').write_text('')


class FromPhotographs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.base = pathlib.Path(tempfile.mkdtemp(prefix='slf-from-photographs-'))
        subprocess.run([SLF, 'synth', 'can', '-o', cls.base / 'can', '--size', '48x48', '--points', '1500', '--circles', '3',
                        '--per-circle', '8', '--supersampling', '1', '--quiet'], check=True)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.base)

    def setUp(self):
        self.place = pathlib.Path(tempfile.mkdtemp(dir=self.base))
        (self.place / 'bin').mkdir()
        colmap = self.place / 'bin/colmap'
        colmap.write_text(COLMAP)
        colmap.chmod(0o755)
        self.output = self.place / 'x.slf'

    def run_script(self, photographs, *options, colmap=True):
        path = f"{self.place / 'bin'}:/usr/bin:/bin" if colmap else '/usr/bin:/bin'
        return subprocess.run([SCRIPT, photographs, '-o', self.output, '--slf', SLF, *options], text=True, capture_output=True,
                              env={**os.environ, 'PATH': path, 'FAKE': str(self.place)}, check=False)

    def asked(self):
        """The steps that COLMAP was called for."""
        file = self.place / 'asked'
        return file.read_text().split() if file.exists() else []

    def test_a_capture_that_is_ready_goes_to_the_encoder(self):
        done = self.run_script(self.base / 'can', *ENCODE, colmap=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.output.read_bytes()[1:4], b'SLF')

    def test_models_in_text_and_in_any_place_are_captures(self):
        for place in ['model', 'model/sparse', 'model/sparse/0', 'model/sparse/1', 'model/colmap/sparse/0']:
            shutil.rmtree(self.place / 'model', ignore_errors=True)
            write_model(self.base / 'can', self.place / place)
            shutil.copytree(self.base / 'can/images', self.place / ('model/colmap/images' if 'colmap' in place else 'model/images'))
            shutil.copy(self.base / 'can/points.ply', self.place / 'model/points.ply')
            done = self.run_script(self.place / 'model', '--', '--points', self.place / 'model/points.ply', *ENCODE[1:])
            self.assertEqual(done.returncode, 0, f'{place}: {done.stderr}')
            self.assertEqual(self.asked(), [], place)

    def test_photographs_go_through_all_steps_once(self):
        write_model(self.base / 'can', self.place / 'model')
        options = ['--', '--points', self.base / 'can/points.ply', *ENCODE[1:]]
        done = self.run_script(self.base / 'can/images', *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        steps = ['feature_extractor', 'exhaustive_matcher', 'mapper']
        self.assertEqual(self.asked(), steps)
        again = self.run_script(self.base / 'can/images', *options)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(self.asked(), steps)
        self.assertIn('mapping: done before', again.stdout)

    def test_photographs_of_other_formats_are_to_be_converted(self):
        photographs = self.place / 'photographs'
        shutil.copytree(self.base / 'can/images', photographs)
        for name in ['a.tif', 'b.HEIC']:
            (photographs / name).write_bytes(b'x')
            done = self.run_script(photographs)
            self.assertEqual(done.returncode, 2)
            self.assertIn('1 photographs are TIFF', done.stderr)
            self.assertIn('mogrify', done.stderr)
            (photographs / name).unlink()
        self.assertEqual(self.asked(), [])

    def test_what_cannot_become_a_model_is_said(self):
        few = self.place / 'few'
        few.mkdir()
        shutil.copy(next((self.base / 'can/images').iterdir()), few)
        self.assertIn('8 are the least', self.run_script(few).stderr)
        self.assertIn('no model came out', self.run_script(self.base / 'can/images').stderr)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
