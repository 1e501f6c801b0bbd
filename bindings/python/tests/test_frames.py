# SPDX-License-Identifier: Apache-2.0
"""Frames of light fields that move, and pictures of splats."""
import hashlib
import io
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import slf

CONFORMANCE = pathlib.Path(os.environ.get('SLF_CONFORMANCE', 'conformance'))
PROGRAM = os.environ.get('SLF_PROGRAM')


def stream(name):
    return (CONFORMANCE / 'streams' / name / 'stream.slf').read_bytes()


class FramesTest(unittest.TestCase):
    def test_digests_of_the_conformance_suite(self):
        checked = 0
        for case in sorted(CONFORMANCE.glob('streams/frames-*/case.json')):
            for expect in json.loads(case.read_text(encoding='utf-8'))['expect']:
                if 'region' in expect or 'max_bytes' in expect:
                    continue
                frames = slf.frames(case.parent / 'stream.slf', levels=expect['levels'],
                                    groups=expect['groups'])
                field = frames[expect.get('frame', 0)]
                for name in ('positions', 'components'):
                    array = getattr(field, name).astype('<i4')
                    self.assertEqual(hashlib.sha256(array.tobytes()).hexdigest(),
                                     expect[f'{name}_sha256'], f'{case.parent.name}: {name}')
                checked += 1
        self.assertGreater(checked, 30)

    def test_a_loop_gives_each_with_its_number_and_time(self):
        frames = slf.frames(stream('frames-groups'))
        self.assertEqual(len(frames), 3)
        numbers = [(field.frame.number, field.frame.time, field.frame.predicted)
                   for field in frames]
        self.assertEqual(numbers, [(0, 0, False), (1, 0.25, True), (2, 0.5, False)])
        self.assertEqual(frames.list[2].offset + frames.list[2].bytes,
                         len(stream('frames-groups')))
        self.assertIsNone(slf.read(stream('frames-groups')).frame)

    def test_any_order_gives_the_same(self):
        frames = slf.frames(stream('frames-levels'))
        in_order = [field.components for field in frames]
        for place in (2, 0, 1, 1, -1):
            self.assertTrue(np.array_equal(frames[place].components, in_order[place]))
        self.assertEqual([len(f) for f in frames[1:]], [len(frames[1]), len(frames[2])])
        with self.assertRaises(IndexError):
            frames[3]

    def test_a_light_field_that_does_not_move_is_one_frame(self):
        data = slf.encode(slf.Capture(np.eye(3), colours=np.full((3, 3), 99, np.uint8)),
                          grid_bits=4).data
        frames = slf.frames(io.BytesIO(data))
        self.assertEqual(len(frames), 1)
        alone = slf.read(data)
        self.assertTrue(np.array_equal(frames[0].positions, alone.positions))
        self.assertEqual(frames[0].header, alone.header)
        camera = alone.orbit(0.1, size=(40, 30))
        self.assertTrue(np.array_equal(frames[0].render(camera), alone.render(camera)))

    def test_damage_costs_a_group_and_no_more(self):
        data = bytearray(stream('frames-groups'))
        second = slf.frames(bytes(data)).list[1]
        data[second.offset + second.bytes // 2] ^= 0x40
        frames = slf.frames(data)
        self.assertEqual(len(frames[0]), 410)
        with self.assertRaises(slf.DamagedError):
            frames[1]
        self.assertEqual(len(frames[2]), 410)
        for nothing in (b'', b'no frame', io.StringIO('text')):
            with self.assertRaises((slf.DamagedError, TypeError)):
                slf.frames(nothing)

    def test_threads_share_one_object(self):
        frames = slf.frames(stream('frames-levels'))
        wanted = [field.components for field in frames]
        wrong = []

        def decode(start):
            for step in range(12):
                place = (start + step) % len(wanted)
                if not np.array_equal(frames[place].components, wanted[place]):
                    wrong.append(place)
        threads = [threading.Thread(target=decode, args=(t,)) for t in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


class SplatsTest(unittest.TestCase):
    @unittest.skipUnless(PROGRAM, 'SLF_PROGRAM: the program is not named')
    def test_pictures_have_their_extent(self):
        names = 'x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3'
        header = 'ply\nformat binary_little_endian 1.0\nelement vertex 2\n' + ''.join(
            f'property float {name}\n' for name in names.split()) + 'end_header\n'
        splats = [[x, 0, 0, 1.7, -1.7, -1.7, 8, -1, -1, -1, 1, 0, 0, 0] for x in (-0.5, 0.5)]
        with tempfile.TemporaryDirectory() as directory:
            ply, coded = (os.path.join(directory, name) for name in ('two.ply', 'two.slf'))
            with open(ply, 'wb') as file:
                file.write(header.encode())
                file.write(b''.join(struct.pack('<14f', *values) for values in splats))
            subprocess.run([PROGRAM, 'encode', ply, '-o', coded, '--quiet'], check=True)
            with open(coded, 'rb') as file:
                field = slf.read(file)
        camera = slf.Camera.look_at([0, -6, 0], [0, 0, 0], size=(60, 60), fov=40)
        picture = field.render(camera, background=(0, 0, 0)).astype(int)
        red = (picture[..., 0] > 120) & (picture[..., 1] < 60)
        self.assertGreater(red.sum(), 100)  # two discs of two points would be a few
        self.assertEqual(picture[0, 0].tolist(), [0, 0, 0])


if __name__ == '__main__':
    unittest.main()
