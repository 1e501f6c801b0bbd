#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the targets that need the decoder alone, each with its seeds and the dictionary, into $OUT. The service
# sets CXX, CXXFLAGS (sanitizers), LIB_FUZZING_ENGINE and OUT; `tests/fuzz/service/build.sh` by itself uses clang's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
[[ -d ../../../codec ]] && cd ../../.. || cd "$SRC/slf"
: "${CXX:=clang++}" "${CXXFLAGS:=-O1 -g1 -fsanitize=address,undefined,fuzzer-no-link}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
: "${OUT:=$PWD/build-service/out}"
mkdir -p "$OUT"
cmake -S . -B build-service -G Ninja -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_CXX_FLAGS="$CXXFLAGS" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG= -DCMAKE_UNITY_BUILD=ON -DSLF_DECODER_ONLY=ON -DSLF_THREADS=OFF -DSLF_C=OFF -DSLF_TESTS=OFF -DSLF_BENCH=OFF
cmake --build build-service --target slf_decoder
python3 tests/fuzz/make_seeds.py build-service/seeds
for target in decode frames render part_decoder; do
  lead=0  # bytes before the stream
  [[ $target == part_decoder ]] && lead=2
  $CXX $CXXFLAGS -std=c++20 -I. -Iinclude -DSLF_FUZZ_LEAD=$lead tests/fuzz/{fuzz_$target,fuzz,mutate_units}.cpp build-service/libslf_decoder.a \
    $LIB_FUZZING_ENGINE -o "$OUT/fuzz_$target"
  cp tests/fuzz/slf.dict "$OUT/fuzz_$target.dict"
  (cd build-service/seeds && python3 -m zipfile -c "$OUT/fuzz_${target}_seed_corpus.zip" $target/*)
done
