#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The promise that files stay, kept by programs of the past: builds the decoder of every version that releases.txt lists, from
# its commit, and runs it over today's streams of the format's number that it knows. A stream of a later number it reads or refuses.
# Exit code: 1 where one differs; 77 where the commits are not there (a shallow clone).
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# header-order-1: a direction 1e-9 beside a jump of a constant function; compilers round the two sides of it apart.
judged() {  # DECODER STREAM...: run.py over these
  local only=()
  for name in "${@:2}"; do only+=(--only "streams/$name"); done
  python3 conformance/run.py --jobs "$(nproc)" --decoder "$1 decode {in} --dump {out} {options}" \
    --radiance "$1 radiance {in} {point} {x} {y} {z}" --without-colours streams/header-order-1 "${only[@]}"
}

refuses() {  # DECODER STREAM: or decodes; neither dies nor hangs
  local code=0
  timeout 60 "$1" info "conformance/streams/$2/stream.slf" >"$work/said" 2>&1 || code=$?
  [[ $code -lt 124 ]] || { echo "$2: code $code"; return 1; }
}

missing=0
while read -r version commit number; do
  [[ $version != \#* ]] || continue
  git cat-file -e "$commit" 2>/dev/null || { echo "$version: skipped, there is no commit $commit"; missing=1; continue; }
  mkdir "$work/$version"
  git archive "$commit" | tar x -C "$work/$version"
  (cd "$work/$version"
   cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DSLF_DECODER_ONLY=ON -DSLF_DRACO=ON -DSLF_HEVC=ON \
     -DSLF_C=OFF -DSLF_TESTS=OFF -DSLF_BENCH=OFF
   cmake --build build --target slf_decoder) >"$work/log" 2>&1 || { tail -n 20 "$work/log"; echo "$version: does not build"; exit 1; }
  c++ -std=c++20 -O1 -I"$work/$version/include" "$work/$version/conformance/suite_decoder.cpp" "$work/$version/build/libslf_decoder.a" \
    -ldraco -lde265 -lz -pthread -o "$work/$version/decoder"
  mapfile -t known < <(awk '{print $2}' "conformance/digests/$number")
  judged "$work/$version/decoder" "${known[@]}"
  later=0
  for stream in conformance/streams/*/; do
    name=$(basename "$stream")
    [[ " ${known[*]} " != *" $name "* ]] || continue
    refuses "$work/$version/decoder" "$name"
    later=$((later + 1))
  done
  echo "$version: reads ${#known[@]} streams of format $number to the same integers; $later of later numbers are read or refused"
done <conformance/releases.txt
exit $((missing * 77))
