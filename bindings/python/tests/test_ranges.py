# SPDX-License-Identifier: Apache-2.0
"""Files and addresses of which no more is read than a decode takes."""
import contextlib
import http.server
import io
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest
import urllib.error

import numpy as np

import slf
from slf import _ranges


def dense(points=60000, seed=5):
    """A sphere of colours by chance: finer levels of them are most of its bytes."""
    random = np.random.default_rng(seed)
    where = random.normal(size=(points, 3))
    where /= np.linalg.norm(where, axis=1)[:, None]
    return slf.encode(slf.Capture(where, colours=random.integers(0, 256, (points, 3), np.uint8)), q=1, grid_bits=7).data


class Counting(io.BytesIO):
    """Counts what is read of it."""
    read_bytes = 0

    def read(self, size=-1):
        data = super().read(size)
        self.read_bytes += len(data)
        return data


@contextlib.contextmanager
def served(data, ranges=True, changes=False):
    """A server with one file; what it was asked for."""
    asked = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            wanted = self.headers.get('Range')
            asked.append(wanted)
            tag = f'"{len(asked) if changes else 0}"'
            if self.path != '/x.slf':
                self.send_error(404)
                return
            same = self.headers.get('If-Range', tag) == tag
            if ranges and wanted and not data:
                self.send_error(416)
                return
            begin, end = 0, len(data)
            if ranges and wanted and same:
                begin, last = map(int, wanted.removeprefix('bytes=').split('-'))
                end = min(last + 1, len(data))
            self.send_response(206 if ranges and wanted and same else 200)
            if ranges and wanted and same:
                self.send_header('Content-Range', f'bytes {begin}-{end - 1}/{len(data)}')
            self.send_header('ETag', tag)
            self.send_header('Content-Length', str(end - begin))
            self.end_headers()
            self.wfile.write(data[begin:end])

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(('127.0.0.1', 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f'http://127.0.0.1:{server.server_port}/x.slf', asked
        server.shutdown()


class RangesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = dense()

    def expect_same(self, a, b):
        self.assertTrue(np.array_equal(a.positions, b.positions))
        self.assertTrue(np.array_equal(a.components, b.components))
        self.assertEqual(a.partial, b.partial)

    def test_part_of_a_file_is_read_where_it_lies(self):
        file = Counting(self.data)
        field = slf.read(file, levels=5)
        self.expect_same(field, slf.read(self.data, levels=5))
        self.assertLess(file.read_bytes, 0.75 * len(self.data))
        with tempfile.NamedTemporaryFile(suffix='.slf') as path:
            path.write(self.data)
            path.flush()
            self.expect_same(slf.read(path.name, levels=5), field)
            self.expect_same(slf.read(path.name), slf.read(self.data))
            self.assertEqual(slf.info(path.name).points, slf.info(self.data).points)

    def test_address_is_fetched_by_ranges(self):
        with served(self.data) as (address, asked):
            field = slf.read(address, levels=5)
            self.expect_same(field, slf.read(self.data, levels=5))
            self.assertTrue(all(asked))
            self.expect_same(slf.read(address), slf.read(self.data))
            self.assertEqual(slf.info(address).points, slf.info(self.data).points)

    def test_path_that_cannot_be_sought_in_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'pipe.slf')
            os.mkfifo(path)
            writing = threading.Thread(target=lambda: pathlib.Path(path).write_bytes(self.data))
            writing.start()
            try:
                self.expect_same(slf.read(path), slf.read(self.data))
            finally:
                writing.join()
        program = 'import sys, slf; print(len(slf.read("/dev/stdin")))'
        said = subprocess.run([sys.executable, '-c', program], input=self.data, stdout=subprocess.PIPE, check=True).stdout
        self.assertEqual(int(said), len(slf.read(self.data)))

    def test_an_empty_file_at_an_address_is_said_to_be_one(self):
        for ranges in (True, False):
            with served(b'', ranges=ranges) as (address, _):
                for use in (slf.read, slf.info, slf.frames, lambda source: slf.read(source, levels=3)):
                    with self.subTest(ranges=ranges), self.assertRaisesRegex(slf.DamagedError, f'{address}: the file is empty'):
                        use(address)

    def test_server_without_ranges_gives_the_whole(self):
        with served(self.data, ranges=False) as (address, _):
            self.expect_same(slf.read(address, levels=5), slf.read(self.data, levels=5))

    def test_file_that_changes_meanwhile_is_an_error(self):
        short, _ranges._FIRST = _ranges._FIRST, 512
        try:
            with served(self.data, changes=True) as (address, _), self.assertRaises(OSError):
                slf.read(address, levels=5)
        finally:
            _ranges._FIRST = short

    def test_address_that_is_not_there_is_an_error_of_its_own(self):
        with served(self.data) as (address, _), self.assertRaises(urllib.error.HTTPError):
            slf.read(address + 'x', levels=5)

    def test_file_that_ends_early_is_refused(self):
        with self.assertRaises(slf.DamagedError):
            slf.read(io.BytesIO(self.data[:-100]), levels=5)

    def test_pictures_and_pickles_of_a_part(self):
        field, whole = slf.read(io.BytesIO(self.data), levels=5), slf.read(self.data, levels=5)
        camera = whole.orbit(0.2, size=(64, 48))
        self.assertTrue(np.array_equal(field.render(camera), whole.render(camera)))
        self.expect_same(pickle.loads(pickle.dumps(field)), whole)


if __name__ == '__main__':
    unittest.main()
