#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/fuzz/run.sh SECONDS [TARGET...]: every target (or those named) under AddressSanitizer and
# UndefinedBehaviorSanitizer, as many at a time as there are cores. SECONDS are those of one core,
# shared alike by all targets: with two cores it is done in half of them. Prints the runs of each.
# Needs clang.
# BUILD_DIR: a build with SLF_FUZZ and the sanitizers (default: build-fuzz, made here).
# What is found stays in build-fuzz/finds/TARGET; once mended it belongs in tests/fuzz/finds/TARGET, which
# the tests replay. The corpus in build-fuzz/corpus grows from call to call.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:?seconds of one core for all targets together}
shift
all=(decode frames render truncate annotate export part_decoder html hevc npy ply scan obj glb image cameras colmap igc part plan splats)
targets=("$@")
[[ $# -gt 0 ]] || targets=("${all[@]}")
build=${BUILD_DIR:-build-fuzz}

# A directory that is configured for it is taken as it is.
[[ -n ${BUILD_DIR:-} ]] || cmake -S . -B $build -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSLF_FUZZ=ON -DSLF_TESTS=OFF -DSLF_BENCH=OFF -DSLF_TOOLS=OFF \
  -DSLF_SANITIZE=address,undefined,fuzzer-no-link > $build.log
cmake --build $build --target "${targets[@]/#/fuzz_}" >> $build.log
python3 tests/fuzz/make_seeds.py $build/seeds ${SLF_PROGRAM:+--slf "$SLF_PROGRAM"}

share=$(( seconds / ${#targets[@]} > 0 ? seconds / ${#targets[@]} : 1 ))
fuzz() {
  local target=$1 status=0 known=()
  mkdir -p $build/corpus/$target $build/finds/$target $build/seeds/$target
  [[ -d tests/fuzz/finds/$target ]] && known=(tests/fuzz/finds/$target)
  # malloc limits stand for hostile sizes: what is larger is refused with bad_alloc or an error.
  ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1 \
    $build/tests/fuzz/fuzz_$target -max_total_time=$share -timeout=20 -rss_limit_mb=2048 -max_len=4096 \
    -dict=tests/fuzz/slf.dict -artifact_prefix=$build/finds/$target/ -print_final_stats=1 -verbosity=1 \
    $build/corpus/$target $build/seeds/$target "${known[@]}" > $build/$target.log 2>&1 || status=1
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' $build/$target.log)
  edges=$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' $build/$target.log | tail -1)
  echo "$target: ${runs:-0} runs, ${edges:-0} edges, $(find $build/finds/$target -type f | wc -l) finds"
  return $status
}
export -f fuzz
export build share
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -euo pipefail -c 'fuzz {}' || exit 1
