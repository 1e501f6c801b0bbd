#!/usr/bin/env bash
# Installs what is needed, builds release and runs all tests. Arguments go to cmake, e.g.
# -DSLF_WERROR=ON. Safe to repeat. BUILD_DIR: where to build (default: build).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh lab
build=${BUILD_DIR:-build}
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSLF_TESTS=ON -DSLF_X265=ON -DSLF_AV1=ON "$@"
cmake --build "$build"
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
