# SPDX-License-Identifier: Apache-2.0
"""The package as a user meets it: arrays, pictures and errors."""
import dataclasses
import json
import os
import pathlib
import signal
import tempfile
import threading
import unittest

import numpy as np

import slf

CONFORMANCE = pathlib.Path(os.environ.get('SLF_CONFORMANCE', 'conformance'))


def disc(points=400, seed=3):
    """A coloured disc, without cameras."""
    random = np.random.default_rng(seed)
    angle, radius = random.uniform(0, 2 * np.pi, points), np.sqrt(random.uniform(0, 1, points))
    where = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    return slf.Capture(where, colours=(127 + 120 * where).astype(np.uint8))


class ReadTest(unittest.TestCase):
    def setUp(self):
        self.encoded = slf.encode(disc(), q=1, grid_bits=7)
        self.field = slf.read(self.encoded.data)

    def test_arrays_have_the_shapes_that_are_documented(self):
        field, count = self.field, len(self.field)
        self.assertEqual(count, self.encoded.points)
        for array, shape, kind in [
                (field.positions, (count, 3), np.int32), (field.points, (count, 3), np.float64),
                (field.components, (count, field.header.components, 3), np.int32),
                (field.normals, (count, 3), np.float32), (field.radii, (count,), np.float32),
                (field.mean_colours, (count, 3), np.uint8)]:
            self.assertEqual((array.shape, array.dtype), (shape, kind))
            self.assertFalse(array.flags.writeable)
        self.assertIs(field.positions, field.positions)
        self.assertEqual(slf.info(self.encoded.data), field.header)

    def test_colours_are_those_that_were_encoded(self):
        x_y_z = self.field.points
        wanted = 127 + 120 * x_y_z
        error = np.abs(self.field.mean_colours - wanted)
        self.assertLess(np.median(error), 3)  # the step is 1, and points are moved to voxels
        seen = self.field.radiance(np.arange(len(self.field)), [0, 0, 1])
        self.assertLess(np.abs(seen - self.field.mean_colours).max(), 1)

    def test_radiance_broadcasts(self):
        one = self.field.radiance(5, [0, 0, 1])
        grid = self.field.radiance(np.arange(4)[:, None], np.ones((3, 3)))
        self.assertEqual((one.shape, grid.shape), ((3,), (4, 3, 3)))
        self.assertEqual(self.field.radiance(np.zeros(0, int), np.zeros((0, 3))).shape, (0, 3))
        for points, directions, error in [
                (len(self.field), [0, 0, 1], IndexError), (-1, [0, 0, 1], IndexError),
                (0.5, [0, 0, 1], ValueError), (0, [0, 1], ValueError),
                (0, [0, 0, np.nan], ValueError), (0, [0, 0, 0], ValueError), ([0, 1], np.ones((3, 3)), ValueError)]:
            with self.assertRaises(error):
                self.field.radiance(points, directions)

    def test_pictures_show_the_disc_where_it_is(self):
        camera = slf.Camera.look_at([0, 0, 4], [0, 0, 0], up=[0, 1, 0], size=(80, 60), fov=40)
        picture = self.field.render(camera, background=(0, 0, 0))
        self.assertEqual((picture.shape, picture.dtype), ((60, 80, 3), np.uint8))
        self.assertEqual(picture[0, 0].tolist(), [0, 0, 0])
        middle = picture[30, 40].astype(int)
        self.assertLess(np.abs(middle - 127).max(), 12)
        self.assertGreater(picture[30, 52, 0], picture[30, 28, 0] + 60)  # red grows with x: right
        self.assertGreater(picture[18, 40, 1], picture[42, 40, 1] + 60)  # green with y: up
        self.assertEqual(self.field.render(camera, size=(40, 30)).shape, (30, 40, 3))
        around = self.field.orbit(0.2, size=(32, 32))
        self.assertTrue((self.field.render(around) != 128).any())
        with self.assertRaises(ValueError):
            self.field.render(slf.Camera(10, 10, np.eye(2), np.eye(3), np.zeros(3)))
        for background in [(300, 0, 0), (0, 0), 7, (0.5, 0, 0), None]:
            with self.assertRaises(slf.ArgumentError):
                self.field.render(camera, background=background)

    def test_parts_are_read(self):
        coarse = slf.read(self.encoded.data, levels=4)
        self.assertLess(len(coarse), len(self.field))
        self.assertAlmostEqual(coarse.step, 8 * self.field.step)
        half = slf.read(self.encoded.data, region=([0, -2, -2], [2, 2, 2]))
        self.assertTrue((half.points[:, 0] > -self.field.step).all())
        self.assertLess(len(half), len(self.field))
        with self.assertRaises(slf.ArgumentError):
            slf.read(self.encoded.data, levels=20)
        with self.assertRaises(slf.LimitError):
            slf.read(self.encoded.data, max_memory=1000)

    def test_fewer_quality_layers_are_a_coarser_field_of_the_same_points(self):
        data = slf.encode(disc(), q=1, grid_bits=7, quality_layers=3).data
        whole = slf.read(data)
        errors = []
        for layers in (1, 2, 3):
            field = slf.read(data, layers=layers)
            self.assertEqual(field.partial, layers < 3)
            np.testing.assert_array_equal(field.positions, whole.positions)
            errors.append(np.abs(field.components - whole.components).mean())
            if layers < 3:
                self.assertTrue((field.render(field.orbit(0.2, 60, (40, 40))) !=
                                 whole.render(whole.orbit(0.2, 60, (40, 40)))).any())
        self.assertGreater(errors[0], errors[1])
        self.assertGreater(errors[1], errors[2])
        self.assertEqual(errors[2], 0)
        with self.assertRaises(slf.ArgumentError):
            slf.read(data, layers=5)
        with self.assertRaises(ValueError):
            slf.encode(disc(), quality_layers=5)

    def test_paths_and_all_kinds_of_bytes(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / 'x.slf'
            self.encoded.write(path)
            sources = [path, str(path), self.encoded.data, bytearray(self.encoded.data),
                       memoryview(self.encoded.data)]
            for source in sources:
                np.testing.assert_array_equal(slf.read(source).components, self.field.components)
            self.assertEqual(os.listdir(directory), ['x.slf'])
        with self.assertRaises(FileNotFoundError):
            slf.read('no such file.slf')
        with self.assertRaises(TypeError):
            slf.read(7)

    def test_threads_decode_beside_each_other(self):
        found = []
        threads = [threading.Thread(target=lambda: found.append(slf.read(self.encoded.data).components))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for components in found:
            np.testing.assert_array_equal(components, self.field.components)
        self.assertEqual(len(found), 4)


class PackTest(unittest.TestCase):
    def test_integers_come_back(self):
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 6, 7]])
        components = np.arange(24).reshape(4, 2, 3) - 12
        data = slf.pack(positions, components, metadata=[('name', 'four')])
        field = slf.read(data)
        np.testing.assert_array_equal(field.positions, positions)
        self.assertLessEqual(np.abs(field.components - components).max(), 1)  # a step
        self.assertIn(('name', 'four'), field.header.metadata)
        with self.assertRaises(slf.Error):
            field.mean_colours
        with self.assertRaises(slf.InputError):
            field.orbit(0)

    def test_wrong_arrays_are_refused(self):
        four = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 6, 7]])
        for positions, components, error in [
                (four[:, :2], None, ValueError), (four + 0.5, None, ValueError),
                (four, np.zeros((3, 2, 3), int), ValueError),
                (four, np.full((4, 2, 3), 1 << 40), ValueError),
                (np.zeros((2, 3), int), None, slf.ArgumentError),
                (four - 1, None, slf.ArgumentError)]:
            with self.assertRaises(error):
                slf.pack(positions, components)


class EncodeTest(unittest.TestCase):
    def test_photographs_in_memory(self):
        def photograph(camera):
            y, x = np.mgrid[0:48, 0:48]
            shade = np.stack([4 * x, 4 * y, 0 * x + 90], axis=2).astype(np.uint8)
            return shade
        cameras = [slf.Camera.look_at([3 * np.sin(a), 0.5, 3 * np.cos(a)], [0, 0, 0], up=[0, 1, 0],
                                      size=(48, 48), fov=50)
                   for a in np.linspace(-0.6, 0.6, 6)]
        capture = disc(900)
        capture.cameras, capture.images = cameras, [photograph(c) for c in cameras]
        capture.colours, capture.normals = None, np.tile([0.0, 0.0, 1.0], (900, 1))
        stages = []
        encoded = slf.encode(capture, split='all', effort=1, grid_bits=6,
                             progress=lambda stage, fraction: stages.append((stage, fraction)))
        self.assertGreater(encoded.observations, 1000)
        self.assertTrue(stages)
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction in stages))
        self.assertGreater(slf.info(encoded.data).functions, 1)

        capture.images[2] = np.dstack([capture.images[2], np.zeros((48, 48), np.uint8)])
        masked = slf.encode(capture, split='all', effort=1, grid_bits=6)
        self.assertIn('1 of 6 input photographs have a mask or alpha without', '\n'.join(masked.warnings))
        self.assertLess(masked.observations, encoded.observations)
        capture.images[2] = capture.images[3]
        hidden = dataclasses.replace(capture, images=[np.dstack([image, 0 * image[:, :, 0]]) for image in capture.images])
        with self.assertRaisesRegex(slf.InputError, 'all 6 input photographs are black'):
            slf.encode(hidden, split='all', effort=1)

        called = []

        def fails(stage, fraction):
            called.append(stage)
            raise KeyError(stage)
        with self.assertRaises(KeyError):
            slf.encode(capture, split='all', effort=1, grid_bits=6, progress=fails)
        self.assertEqual(len(called), 1)

        def interrupts(stage, fraction):
            called.append(stage)
            os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            slf.encode(capture, split='all', effort=1, grid_bits=6, progress=interrupts)
        self.assertEqual(len(called), 2)
        capture.images = capture.images[1:]
        with self.assertRaises(ValueError):
            slf.encode(capture)

    def test_what_a_capture_is_warned_of_is_among_the_warnings(self):
        rows = ''.join(f'{i % 7} {i % 5} {i % 3 + i / 50} 9 99 {i}\n' for i in range(39))
        names = ''.join(f'property {kind} {name}\n' for kind, name in
                        [*(('float', n) for n in 'xyz'), *(('uchar', n) for n in ('red', 'green', 'blue'))])
        with tempfile.TemporaryDirectory() as directory:
            cloud = pathlib.Path(directory) / 'x.ply'
            cloud.write_text(f'ply\nformat ascii 1.0\nelement vertex 40\n{names}end_header\nnan 0 0 1 2 3\n{rows}')
            self.assertIn('1 of 40 points are not finite', '\n'.join(slf.encode(cloud).warnings))

    def test_wrong_captures_and_settings_are_refused(self):
        with self.assertRaises(slf.InputError) as caught:
            slf.encode('no such capture')
        self.assertEqual(caught.exception.code, 'SLF_UNREADABLE')
        for wrong in [{'q': 0}, {'q': float('nan')}, {'grid_bits': 22}, {'normal_bits': 2},
                      {'effort': 0}, {'preset': 'best'}]:
            with self.assertRaises(ValueError):
                slf.encode(disc(), **wrong)
        with self.assertRaises(slf.InputError):
            slf.encode(slf.Capture(np.full((3, 3), np.nan), colours=np.zeros((3, 3), np.uint8)))
        with self.assertRaises(ValueError):
            slf.encode(slf.Capture(np.zeros((3, 2))))


class DamageTest(unittest.TestCase):
    def test_every_refused_stream_is_an_exception_and_nothing_grows(self):
        streams = sorted(CONFORMANCE.glob('refused/*/stream.slf'))
        self.assertGreater(len(streams), 40)

        def resident():
            status = pathlib.Path('/proc/self/status').read_text(encoding='ascii')
            return int(status.split('VmRSS:')[1].split()[0])
        before = None
        for round_number in range(20):
            for stream in streams:
                try:
                    slf.read(stream)
                except slf.Error as error:
                    self.assertTrue(error.code.startswith('SLF_'))
                else:
                    # Metadata is not decoded; only `info` of the program refuses it.
                    self.assertEqual(stream.parent.name, 'metadata-garbage')
            before = resident() if round_number == 4 else before
        self.assertLess(resident() - before, 4096)  # KiB; 15 rounds of over 40 streams

    def test_truncations_are_errors_or_partial(self):
        data = slf.encode(disc(60), q=4, grid_bits=5).data
        for size in range(0, len(data), 7):
            try:
                self.assertTrue(slf.read(data[:size]).partial)
            except slf.Error as error:
                self.assertIsInstance(error, slf.DamagedError)

    def test_digests_of_the_conformance_suite(self):
        import hashlib
        checked = 0
        for case in sorted(CONFORMANCE.glob('streams/*/case.json')):
            for expect in json.loads(case.read_text(encoding='utf-8'))['expect']:
                if 'region' in expect or 'max_bytes' in expect or expect.get('frame'):
                    continue
                try:
                    field = slf.read(case.parent / 'stream.slf', levels=expect['levels'],
                                     groups=expect['groups'], layers=expect.get('layers', 0))
                except slf.UnsupportedError:
                    continue  # Draco or HEVC left out
                for name in ('positions', 'components'):
                    array = getattr(field, name).astype('<i4')
                    self.assertEqual(hashlib.sha256(array.tobytes()).hexdigest(),
                                     expect[f'{name}_sha256'], f'{case.parent.name}: {name}')
                checked += 1
        self.assertGreater(checked, 30)


if __name__ == '__main__':
    unittest.main()
