#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-tidy with the checks of .clang-tidy; a finding is an error. It reads the files of a unity build by the dozen.
#
#   .ci/tidy.sh BUILD ROOM...    BUILD: a tree of clang with -DCMAKE_UNITY_BUILD=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
#                                -DCMAKE_EXPORT_COMPILE_COMMANDS=ON, as .ci/nightly configures it; nothing has to be built
#                                ROOM: a folder of the tree; none: all of them
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
shift
rooms=$(IFS='|'; echo "$*")
units() {
  /usr/bin/python3 - "$build" "$@" <<'EOF'
import json, pathlib, re, sys
build, rooms = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
files = sorted({entry['file'] for entry in json.loads((build / 'compile_commands.json').read_text())})
# A target of fuzz programs compiles alone what a unity has, too: once is enough.
seen = {name for file in files if file.endswith('.cxx') for name in re.findall(r'#include "([^"]*)"', pathlib.Path(file).read_text())}
for file in files:
    if file in seen:
        continue
    unity = re.search(r'/unity_([^/]*)_\d+_cxx\.cxx$', file)
    path = pathlib.Path(file)  # those of tests: build/tests/CMakeFiles/THEME_tests.dir/Unity/unity_0_cxx.cxx
    inside = path.relative_to(build if path.is_relative_to(build) else pathlib.Path.cwd())
    room = unity[1] if unity else inside.parent.as_posix().replace('/', '_')
    if file.endswith(('.cpp', '.cxx')) and (not rooms or any(f'{room}_'.startswith(r.replace('/', '_') + '_') for r in rooms)):
        print(file)
EOF
}
units "$@" | xargs -r -d '\n' -P "$(nproc)" -n 1 \
  clang-tidy --quiet -p "$build" --warnings-as-errors='*' --header-filter="^$PWD/($rooms)[^.]*\.(h|cpp)$"
