#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From photographs to .slf and back: tools/demo.sh [CAPTURE]. Without a capture, one of an analytic
# can is made first. Everything lands in build/demo; the last thing printed is a table. Safe to repeat.
set -euo pipefail
if [[ ${1:-} == -h || ${1:-} == --help ]]; then
  sed -n '2,3s/^# //p' "$0"
  exit 0
fi
given=${1:+$(realpath -- "$1")}
cd "$(dirname "$0")/.."

say() { echo "demo: $*" >&2; }

tools/setup.sh
# The viewer, for the page at the end; without it the demo is whole as well.
if [[ ! -e web/dist/one_file.html ]]; then
  say "building the viewer (web/)"
  { tools/setup.sh web && web/build.sh; } >&2 || say "the viewer could not be built"
fi
say "building (build/)"
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON >/dev/null
cmake --build build --target slf_program >&2
slf=build/bin/slf
out=build/demo
mkdir -p "$out"
begin=$(date +%s)

if [[ -n $given ]]; then
  capture=$given
else
  capture=$out/can
  say "synthesising $capture"
  "$slf" synth can -o "$capture" --size 256x256
fi

say "encoding $capture"
"$slf" encode "$capture" -o "$out/demo.slf" --json >"$out/encode.json"
say "decoding"
"$slf" decode "$out/demo.slf" -o "$out/demo.ply" --json >"$out/decode.json"
say "rendering views where no camera stood"
mkdir -p "$out/orbit"
"$slf" render "$out/demo.slf" --orbit 8 --size 512x512 -o "$out/orbit/%03d.png" --json >"$out/render.json"
"$slf" render "$out/demo.slf" --orbit 8 --size 256x256 --sheet -o "$out/contact_sheet.png" --quiet
say "measuring against the photographs"
rm -f "$out/eval.json"
if ! grep -q '"cameras": 0' "$out/encode.json"; then  # a coloured cloud has nothing to be measured against
  "$slf" eval "$out/demo.slf" "$capture" --json >"$out/eval.json"
fi

python3 tools/demo_table.py "$out" "$capture" $(($(date +%s) - begin))

# One page to look at it and to send to somebody.
if "$slf" html "$out/demo.slf" -o "$out/demo.html" --quiet 2>"$out/html.txt"; then
  echo
  echo "Open it in a browser: $PWD/$out/demo.html"
else
  say "no page: $(cat "$out/html.txt")"
fi
