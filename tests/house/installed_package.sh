#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build to a directory of its own, builds docs/examples/ against it through
# find_package(slf), and runs them: the colours of decode_points (node fetches) and of radiance.py
# (the plain sum, in numpy) agree.
#   installed_package.sh CMAKE BUILD SOURCE CXX
set -euo pipefail
cmake=$1 build=$2 source=$3 cxx=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$cmake" --install "$build" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
"$cmake" -S "$source/docs/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release
"$cmake" --build "$work/examples"

cd "$work"
slf=$work/prefix/bin/slf
"$slf" synth can -o tiny --size 48x48 --points 1500 --circles 3 --per-circle 8
examples/encode_capture tiny example.slf
examples/decode_points example.slf
"$slf" info example.slf >/dev/null
"$slf" decode example.slf --dump dump --quiet

# The system's Python has Debian's numpy; another one may come first in PATH.
for python in python3 /usr/bin/python3 none; do
  "$python" -c 'import numpy' 2>/dev/null && break
done
[[ $python != none ]] || { echo "no numpy: radiance.py is not compared"; exit 0; }
for query in "0 1 0 0" "7 -1 2 0.5" "100 0.3 -0.4 -2" "500 0 0 1"; do
  a=$(examples/decode_points example.slf $query)
  b=$("$python" "$source/docs/examples/radiance.py" dump $query)
  echo "$query: $a | $b"
  # World positions are the same; colours to the tolerance of the radiance point, 1/256, and print.
  "$python" - $a $b <<'EOF'
import sys
a, b = ([float(x) for x in sys.argv[i:i + 6]] for i in (1, 7))
assert all(abs(x - y) < 1e-4 for x, y in zip(a[:3], b[:3])), "positions differ"
assert all(abs(x - y) < 1 / 256 + 1e-3 for x, y in zip(a[3:], b[3:])), "colours differ"
EOF
done
