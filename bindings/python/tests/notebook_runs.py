# SPDX-License-Identifier: Apache-2.0
"""docs/examples/notebook.py on a small capture: it ends, and all three of its pictures show something.

77 and a line where a package is missing. PYTHONPATH has the package slf.

    notebook_runs.py NOTEBOOK SLF        SLF: the program
"""
import importlib.util
import pathlib
import subprocess
import sys
import tempfile

for package in ('numpy', 'matplotlib'):
    if importlib.util.find_spec(package) is None:
        print(f'notebook: skipped, {sys.executable} has no {package} (tools/setup.sh lab)')
        sys.exit(77)

import matplotlib.image  # noqa: E402  after what may be missing
import numpy as np  # noqa: E402

NOTEBOOK, SLF = sys.argv[1:]
with tempfile.TemporaryDirectory() as name:
    capture, picture = pathlib.Path(name, 'can'), pathlib.Path(name, 'picture.png')
    subprocess.run([SLF, 'synth', 'can', '-o', capture, '--size', '48x48', '--points', '1500', '--circles', '3',
                    '--per-circle', '8', '--quiet'], check=True)
    subprocess.run([sys.executable, NOTEBOOK, capture, picture], check=True)
    pixels = matplotlib.image.imread(picture)[..., :3]
# Side by side in thirds: view map, rendering, curve. Titles and axes alone have a few grey levels.
for what, third in zip(('view map', 'rendering', 'curve'), np.array_split(pixels, 3, axis=1)):
    coloured = (np.ptp(third, axis=2) > 0.02).sum()
    print(f'{what}: {coloured} coloured pixels of {third[..., 0].size}')
    if coloured < 300:
        sys.exit(f'the {what} is empty')
