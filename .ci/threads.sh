#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Thread sanitizer on streams of several slices: decodes whole, partial, cut and damaged, on four
# threads. Builds the decoder alone (minutes); not part of .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-tsan
cmake -S . -B $build -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSLF_SANITIZE=thread -DSLF_TESTS=OFF -DSLF_BENCH=OFF \
  -DSLF_TOOLS=OFF -DSLF_FUZZ=OFF > $build.log
cmake --build $build --target slf_decoder >> $build.log
clang++ -std=c++20 -O1 -g1 -fsanitize=thread -Iinclude -I. tests/codec/decode_on_threads.cpp tests/fuzz/fuzz.cpp \
  $build/libslf_decoder.a -o $build/decode_on_threads $(pkg-config --libs zlib libde265) -ldraco -lpthread
TSAN_OPTIONS=halt_on_error=1 $build/decode_on_threads conformance/streams/*/stream.slf \
  conformance/refused/*/stream.slf
