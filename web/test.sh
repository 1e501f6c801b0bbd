#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs tests of web/, as web/build.sh has built it; 77 and a line where something for that is missing.
#   web/test.sh node        the decoder, under node
#   web/test.sh browser [NAME]   the viewer, in Chromium (CHROMIUM), against the program slf
#                           (SLF_PROGRAM): test/browser/NAME.test.mjs, or all
#   web/test.sh bundlers [NAME]  what bundlers make of the package, drawn in Chromium; from npm's registry
set -euo pipefail
cd "$(dirname "$0")"
which=${1:-node}

skipped() { echo "web/test.sh $which: skipped, $*"; exit 77; }
command -v node >/dev/null || skipped "there is no node (tools/setup.sh web)"
[[ -e slf.wasm && -e slf_scalar.wasm ]] || skipped "there is no slf.wasm (web/build.sh says why)"
if [[ $which == node ]]; then
  exec node --expose-gc --test test/node/*.test.js
fi
[[ -d node_modules/playwright-core ]] || skipped "there is no node_modules/playwright-core (web/build.sh says why)"
export SLF_PROGRAM=${SLF_PROGRAM:-$PWD/../build/bin/slf}
[[ -x $SLF_PROGRAM ]] || skipped "there is no program slf at $SLF_PROGRAM"
for browser in ${CHROMIUM:-chromium chromium-browser google-chrome}; do
  CHROMIUM=$(command -v "$browser") && break
done
[[ -n ${CHROMIUM:-} ]] || skipped "there is no chromium (tools/setup.sh lab)"
export CHROMIUM
[[ $which != bundlers ]] || exec node test/bundlers/run.mjs "${@:2}"
exec node --test --test-concurrency=1 test/browser/${2:-*}.test.mjs
