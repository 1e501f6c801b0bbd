#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `pip install` of a source distribution, with what a build compiled, in a fresh environment, without a network;
# then the package reads a stream. The distribution is whole: what its files include is in it. 77 and a line where venv or pip is not there.
#   bindings/python/tests/pip_installs.sh PYTHON SOURCE_DIR BUILD_DIR
set -euo pipefail
python=$1 source=$2 build=$3

"$python" -c 'import ensurepip, venv' 2>/dev/null || {
  echo "pip_installs: skipped, $python has no venv or pip (tools/setup.sh lab)"
  exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
PYTHONPATH=$source/bindings/python "$python" - "$folder" <<'PROGRAM'
import pathlib
import re
import sys
import tarfile
import build_backend
folder = pathlib.Path(sys.argv[1])
with tarfile.open(folder / build_backend.build_sdist(folder)) as archive:
    archive.extractall(folder)
root, = (path for path in folder.glob('slf-*') if path.is_dir())
lost = {found for path in root.rglob('*') if path.suffix in ('.h', '.cpp')
        for found in re.findall(r'^#include "([^"]+)"', path.read_text(encoding='utf-8'), re.M)
        if not any((where / found).exists() for where in (root, root / 'include', path.parent))}
assert not lost, lost
PROGRAM
source_of_streams=$source source=$(echo "$folder"/slf-*/)
"$python" -m venv --system-site-packages "$folder/env"
# What is tried is the way of the package into the environment; the build has compiled it.
SLF_PIP_BUILT=$build "$folder/env/bin/pip" install --no-index --no-build-isolation --disable-pip-version-check -q "$source"
cd "$folder"  # nothing of the source folder may be found by chance
"$folder/env/bin/python" - "$source_of_streams/conformance/streams/harmonics/stream.slf" <<'PROGRAM'
import sys
import slf
field = slf.read(sys.argv[1])
assert slf.__file__.startswith(sys.prefix), slf.__file__
assert (files := __import__('importlib.metadata').metadata.files('slf')) and any(f.name == 'LICENSE' for f in files)
assert len(field) > 0 and field.render(field.orbit(0), (32, 32)).shape == (32, 32, 3)
print(slf.__version__, len(field), 'points')
PROGRAM
