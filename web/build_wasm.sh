#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds web/slf.wasm (128-bit vectors) and web/slf_scalar.wasm (without). Needs the packages of
# tools/setup.sh web. Prints their sizes: raw, and as brotli at its best would send them.
# BUILD_DIR: where to build (default: build-wasm). Safe to repeat.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD_DIR:-build-wasm}
mkdir -p "$build"

for kind in simd scalar; do
  [[ $kind == simd ]] && simd=ON name=slf || { simd=OFF; name=slf_scalar; }
  cmake -S . -B "$build/$kind" -G Ninja --toolchain "$PWD/web/wasi.cmake" -DCMAKE_BUILD_TYPE=MinSizeRel \
    -DSLF_DECODER_ONLY=ON -DSLF_TEXTURE=OFF -DSLF_THREADS=OFF -DSLF_C=OFF -DSLF_WASM_SIMD=$simd \
    -DCMAKE_UNITY_BUILD=ON "$@" >"$build/$kind.log" ||
    { cat "$build/$kind.log"; exit 1; }
  cmake --build "$build/$kind" --target slf_wasm -- --quiet
  features=(--enable-bulk-memory --enable-sign-ext --enable-mutable-globals --enable-nontrapping-float-to-int)
  [[ $kind == simd ]] && features+=(--enable-simd)
  linked=$build/$kind/web/wasm/slf.wasm
  # low memory: the far end of the stack (--stack-first), where no pointer to an object is
  if [[ $linked -nt web/$name.wasm || web/build_wasm.sh -nt web/$name.wasm ]]; then
    # what has one caller stays a function: engines compile a large one late (base/multiversion.h)
    wasm-opt "${features[@]}" -O3 --converge --one-caller-inline-max-function-size=60 --low-memory-unused --strip-debug \
      --strip-producers --strip-target-features "$linked" -o "$build/$name.wasm"
    mv "$build/$name.wasm" "web/$name.wasm"  # whole or not at all
  fi
  printf '%s %d bytes, brotli %d\n' "web/$name.wasm" "$(stat -c %s "web/$name.wasm")" \
    "$(brotli -q 11 -c "web/$name.wasm" | wc -c)"
done
