#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is needed, builds release and runs all tests. Arguments go to cmake, e.g.
# -DSLF_WERROR=ON. Safe to repeat. BUILD_DIR: where to build (default: build). SLF_LEAVE_OUT: tests
# to leave out, a regular expression of whole names.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh lab
build=${BUILD_DIR:-build}
# First the page that the program takes in for `slf html`; without it the tests of that say so.
BUILD_DIR=$PWD/$build/wasm web/build.sh || [[ $? -eq 77 ]]
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DSLF_TESTS=ON -DSLF_X265=ON -DSLF_AV1=ON \
  -DSLF_PYTHON=ON "$@"
cmake --build "$build"
# Readers of exported files that are not ours; without them their test is skipped.
if command -v npm >/dev/null && [[ ! -d tests/readers/node_modules ]]; then
  npm ci --silent --no-audit --no-fund --prefix tests/readers || echo "test.sh: three.js is not there" >&2
fi
# Without tests of the tests' own tools, which .ci/nightly runs.
# A test that hangs ends after ten minutes, if it has no time of its own; none takes more than four.
code=0
rm -f "$build/tests.xml"
ctest --test-dir "$build" --output-on-failure --timeout 600 -j "$(nproc)" -LE nightly ${SLF_LEAVE_OUT:+-E "^($SLF_LEAVE_OUT)\$"} --output-junit tests.xml \
  --test-output-size-passed 100000 || code=$?
python3 tools/test_summary.py "$build/tests.xml"  # one line: how many passed, what was skipped and why
exit "$code"
