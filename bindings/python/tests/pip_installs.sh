#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `pip install .` of what a build compiled, in a fresh environment, without a network; then the package
# reads a stream. 77 and a line where venv or pip is not there.
#   bindings/python/tests/pip_installs.sh PYTHON SOURCE_DIR BUILD_DIR
set -euo pipefail
python=$1 source=$2 build=$3

"$python" -c 'import ensurepip, venv' 2>/dev/null || {
  echo "pip_installs: skipped, $python has no venv or pip (tools/setup.sh lab)"
  exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv --system-site-packages "$folder/env"
# What is tried is the way of the package into the environment; the build has compiled it.
SLF_PIP_BUILT=$build "$folder/env/bin/pip" install --no-index --no-build-isolation --disable-pip-version-check -q "$source"
cd "$folder"  # nothing of the source folder may be found by chance
"$folder/env/bin/python" - "$source/conformance/streams/harmonics/stream.slf" <<'PROGRAM'
import sys
import slf
field = slf.read(sys.argv[1])
assert slf.__file__.startswith(sys.prefix), slf.__file__
assert len(field) > 0 and field.render(field.orbit(0), (32, 32)).shape == (32, 32, 3)
print(slf.__version__, len(field), 'points')
PROGRAM
