#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the decoder in WebAssembly (build_wasm.sh) and, with packages of npm, what a package has beside the
# sources (made/) and the page of `slf html` (dist/one_file.html). 77 and a line where a tool or a network is
# missing; what can be built without it is built first. Safe to repeat, quick when nothing has changed; two
# at a time wait for one another.
set -euo pipefail
cd "$(dirname "$0")"
exec 9<.
flock 9

skipped() { echo "web/build.sh: skipped, $*"; exit 77; }
for tool in cmake ninja clang++-19 wasm-ld-19 wasm-opt brotli; do
  command -v "$tool" >/dev/null || skipped "there is no $tool (tools/setup.sh web)"
done
[[ -d /usr/include/wasm32-wasi ]] || skipped "there is no libc for WASI (tools/setup.sh web)"
./build_wasm.sh

for tool in node npm xz; do
  command -v "$tool" >/dev/null || skipped "there is no $tool for the page (tools/setup.sh web)"
done
if [[ package-lock.json -nt node_modules/.package-lock.json ]]; then
  log=$(timeout 300 npm ci --no-audit --no-fund 2>&1) || {
    echo "$log" | tail -5
    grep -qE 'EUSAGE|EINTEGRITY' <<<"$log" && exit 1
    skipped "npm ci did not get the packages of web/package-lock.json (network?)"
  }
fi
newest=$(find viewer build_package.mjs slf*.js start_worker.js slf.wasm -newer made/viewer_markup.js 2>/dev/null || echo all)
[[ -e made/viewer_markup.js && -z "$newest" ]] || node build_package.mjs
newest=$(find viewer slf*.js start_worker.js slf.wasm -newer dist/one_file.html 2>/dev/null || echo all)
[[ -e dist/one_file.html && -z "$newest" ]] || node viewer/build_page.mjs
