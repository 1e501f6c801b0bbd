# SPDX-License-Identifier: Apache-2.0
"""Files made of files, pages, and quality against photographs."""
import base64
import io
import json
import pathlib
import re
import tempfile
import unittest
import unittest.mock

import numpy as np

import slf
from slf import _page
from test_slf import disc


def photographed():
    """A disc with photographs of itself: those of an encoded one."""
    field = slf.read(slf.encode(disc(900), q=1, grid_bits=6).data)
    capture = disc(900)
    capture.normals = np.tile([0.0, 0.0, 1.0], (900, 1))
    capture.cameras = [slf.Camera.look_at([3 * np.sin(a), 0.5, 3 * np.cos(a)], [0, 0, 0], up=[0, 1, 0],
                                          size=(48, 48), fov=50) for a in np.linspace(-0.6, 0.6, 8)]
    capture.images = [field.render(camera) for camera in capture.cameras]
    return capture


class FilesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = slf.encode(disc(), q=2, grid_bits=7).data

    def test_a_shorter_file_decodes_to_what_was_asked_for(self):
        kept = slf.truncate(io.BytesIO(self.data), levels=5)
        self.assertLess(len(kept), len(self.data))
        self.assertTrue(np.array_equal(slf.read(kept).components, slf.read(self.data, levels=5).components))
        half = slf.truncate(self.data, max_bytes=len(self.data) * 3 // 4)
        self.assertLessEqual(len(half), len(self.data) * 3 // 4)
        self.assertTrue(slf.read(half).partial)
        with self.assertRaisesRegex(slf.ArgumentError, 'levels'):
            slf.truncate(self.data, levels=9)
        with self.assertRaises(slf.DamagedError):
            slf.truncate(b'no stream')

    def test_notes_and_scale_are_written_into_a_file_that_is_there(self):
        notes = {'version': 1, 'annotations': [{'at': [0, 0, 1], 'title': 'Rim'}]}
        noted = slf.annotate(self.data, notes=notes, metres_per_unit=0.5)
        self.assertEqual(json.loads(dict(slf.info(noted).metadata)['notes']), notes)
        self.assertTrue(np.array_equal(slf.read(noted).components, slf.read(self.data).components))
        self.assertEqual(slf.annotate(noted, remove_notes=True, metres_per_unit=0), self.data)
        with self.assertRaises(slf.InputError):
            slf.annotate(self.data, notes={'version': 2})

    def test_splats_are_those_of_the_format_that_is_named(self):
        for name, begins in [('ply', b'ply'), ('glb', b'glTF'), ('spz', b'\x1f\x8b'), ('spz3', b'\x1f\x8b')]:
            self.assertTrue(slf.export(self.data, name, degree=1).startswith(begins), name)
        self.assertLess(len(slf.export(self.data, degree=0)), len(slf.export(self.data, degree=3)))
        self.assertLess(len(slf.export(self.data, levels=4)), len(slf.export(self.data)))
        for wrong in [{'format': 'obj'}, {'axes': 'up'}, {'degree': 4}, {'size': 9}, {'size': float('nan')}]:
            with self.assertRaises(slf.ArgumentError):
                slf.export(self.data, **wrong)
        with self.assertRaises(slf.InputError):
            slf.export(slf.pack(np.eye(3, dtype=int), np.zeros((3, 1, 3), int)))

    def test_paths_and_open_files_give_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / 'x.slf'
            path.write_bytes(self.data)
            for made in (lambda source: slf.truncate(source, levels=5), slf.export):
                with path.open('rb') as file:
                    self.assertEqual(made(path), made(file))
            path.write_bytes(b'no stream')
            for function in (slf.truncate, slf.export):
                with self.assertRaisesRegex(slf.DamagedError, 'x.slf'):
                    function(path)


class PageTest(unittest.TestCase):
    TEMPLATE = '<title>{{slf:title}}</title>{{slf:night}}|{{slf:poster}}|{{slf:options}}|{{slf:file}}|{{slf:none}}'

    def page(self, source, **given):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / 'one_file.html').write_text(self.TEMPLATE, encoding='utf-8')
            with unittest.mock.patch.object(_page, '__file__', str(pathlib.Path(folder) / '_page.py')):
                return slf.html(source, **given)

    def test_a_page_holds_the_file_its_posters_and_how_it_is_shown(self):
        data = slf.encode(disc(), q=2, grid_bits=6).data
        page = self.page(data, title='</script>"é', azimuth=40, autorotate=5)
        head, poster, options, file, none = page.split('|')
        self.assertEqual(base64.b64decode(file), data)
        self.assertIn('&lt;/script&gt;', head)
        self.assertNotIn('</script>', options)
        self.assertEqual(json.loads(options), {'title': '</script>"é', 'azimuth': 40, 'elevation': 20, 'fov': 30,
                                               'autorotate': 5})
        for picture in (re.search('srcset="(.*?)"', head)[1], poster):
            self.assertTrue(base64.b64decode(picture.split(',')[1]).startswith(b'\xff\xd8'))
        self.assertEqual(none, '')

    def test_one_background_has_one_poster_and_a_camera_is_the_first_view(self):
        data = slf.encode(disc(), q=2, grid_bits=6).data
        camera = slf.Camera.look_at([0, 0, 4], [0, 0, 0], up=[0, 1, 0], size=(80, 60), fov=40)
        head, _, options, _, _ = self.page(data, camera=camera, background=(1, 2, 255)).split('|')
        self.assertNotIn('srcset', head)
        options = json.loads(options)
        self.assertEqual(options['background'], '0102ff')
        self.assertEqual((options['view']['width'], options['view']['eye']), (80, [0, 0, 4]))
        self.assertEqual(self.page(data, poster=False).split('|')[1], 'data:,')
        for wrong in [{'azimuth': 400}, {'fov': 0}, {'speed': 0}, {'autorotate': 'a'}, {'background': (1, 2)}]:
            with self.assertRaises(slf.ArgumentError):
                self.page(data, **wrong)

    def test_notes_and_metres_are_in_the_file_and_on_the_page(self):
        notes = {'version': 1, 'annotations': [{'at': [0, 0, 1], 'title': 'Rim'}]}
        data = slf.encode(disc(), q=2, grid_bits=6, notes=notes, metres_per_unit=0.01).data
        header = slf.info(data)
        self.assertEqual(json.loads(dict(header.metadata)['notes']), notes)
        self.assertEqual(header.metres_per_unit, 0.01)
        options = json.loads(self.page(data, poster=False, notes=notes, metres_per_unit=2).split('|')[2])
        self.assertEqual((options['notes'], options['metres']), (notes, 2))
        notes['annotations'][0]['title'] = '<b>Rim</b>'
        for call in (lambda: self.page(data, notes=notes), lambda: slf.encode(disc(), notes=notes)):
            with self.assertRaisesRegex(slf.InputError, r'notes: annotations\[0\]\.title: has markup'):
                call()
        with self.assertRaises(OSError):
            self.page(data, notes='nowhere.json')

    def test_a_package_without_the_viewer_says_so(self):
        with unittest.mock.patch.object(_page, '__file__', '/nowhere/_page.py'):
            with self.assertRaisesRegex(slf.UnsupportedError, 'one_file.html'):
                slf.html(b'')


class EvalTest(unittest.TestCase):
    def test_a_finer_step_is_nearer_to_the_photographs(self):
        capture = photographed()
        measured = []
        for q in (2, 64):
            data = slf.encode(capture, q=q, grid_bits=6, effort=1, surface='given').data
            measured.append(slf.eval(data, capture, deltas=[10, 60], progress=lambda stage, fraction: None))
        fine, coarse = measured
        self.assertEqual((fine.input.cameras, fine.held_out.cameras), (6, 2))
        self.assertEqual([p.delta for p in fine.input.points], [10, 60])
        self.assertGreater(fine.input.points[1].psnr, coarse.input.points[1].psnr)
        self.assertGreater(fine.held_out.image.psnr, 20)
        self.assertEqual(len(fine.input.image.psnr_each), 6)
        without = slf.eval(data, capture, images=False, split='all')
        self.assertEqual((without.input.cameras, without.input.image, without.held_out), (8, None, None))

    def test_what_is_wrong_is_named(self):
        data = slf.encode(disc(), q=2, grid_bits=6).data
        with self.assertRaisesRegex(slf.ArgumentError, 'deltas'):
            slf.eval(data, disc(), deltas=[91])
        with self.assertRaises(slf.InputError):
            slf.eval(data, 'no such capture')
        with self.assertRaises(KeyError):
            def fails(stage, fraction):
                raise KeyError(stage)
            slf.eval(data, photographed(), progress=fails)


if __name__ == '__main__':
    unittest.main()
