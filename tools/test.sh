#!/usr/bin/env bash
# Installs what is needed, builds release and runs all tests. Arguments go to cmake, e.g.
# -DSLF_WERROR=ON. Safe to repeat. BUILD_DIR: where to build (default: build).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh
build=${BUILD_DIR:-build}
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSLF_TESTS=ON "$@"
cmake --build "$build"
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
