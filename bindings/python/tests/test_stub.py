# SPDX-License-Identifier: Apache-2.0
"""The stub says what the extension module has."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import slf
from slf import _slf

CLASSES = ('Field', 'FramePictures', 'Frames', 'Renderer')  # of the extension module


class StubTest(unittest.TestCase):
    def test_types_agree_with_the_module(self):
        tool = [sys.executable, '-m', 'mypy']
        if subprocess.run([*tool, '--version'], capture_output=True).returncode:
            self.skipTest('mypy is not installed')
        package = pathlib.Path(slf.__file__).parent
        with tempfile.TemporaryDirectory() as directory:
            environment = {**os.environ, 'MYPYPATH': str(package.parent),
                           'PYTHONPATH': str(package.parent)}
            # Classes of pybind11 have a metaclass of its own; their members are compared.
            allowed = pathlib.Path(directory) / 'allowed'
            allowed.write_text(''.join(f'slf._slf.{name}\n' for name in CLASSES), encoding='ascii')
            for command in [[*tool, '--strict', '-p', 'slf'],
                            [sys.executable, '-m', 'mypy.stubtest', 'slf._slf', '--allowlist',
                             str(allowed)]]:
                ran = subprocess.run(command, capture_output=True, text=True, cwd=directory,
                                     env=environment)
                self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)

    def test_everything_in_the_stub_is_in_the_module_and_the_other_way_round(self):
        stub = (pathlib.Path(slf.__file__).parent / '_slf.pyi').read_text(encoding='utf-8')
        for owner in [_slf, *(getattr(_slf, name) for name in CLASSES)]:
            for name in [n for n in vars(owner) if not n.startswith('_')]:
                self.assertRegex(stub, rf'\b(def|class) {name}\b')
        for name in re.findall(r'^(?:def|class) (\w+)', stub, re.M):
            self.assertTrue(hasattr(_slf, name), name)


if __name__ == '__main__':
    unittest.main()
