#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The same integers on every machine: builds the decoder alone, on one thread and without other libraries,
# for each machine named and runs it over the conformance suite, colours included.
#   conformance/machines.sh [NAME...]    (default: all of them)
#     s390x aarch64 riscv64 i686         Debian's cross compilers, under qemu-user; s390x is big endian,
#                                        i686 has sizes of 32 bits, char is unsigned on all but i686
#     windows                            mingw-w64, under wine
#     gcc-O0 gcc-O3 clang-O0 clang-O3    this machine
#     wasm                               web/slf.wasm and slf_scalar.wasm, if built, under node
# Prints of each: streams and refusals that passed, digests compared, seconds of building and of decoding.
# Exit code: 1 where one differs; 77 where none does, and something is missing, which is named
# (tools/setup.sh machines installs it). MACHINES_BUILD: where to build [build-machines].
set -euo pipefail
cd "$(dirname "$0")/.."
build=${MACHINES_BUILD:-build-machines}
[[ $# -gt 0 ]] || set -- s390x aarch64 riscv64 i686 windows gcc-O0 gcc-O3 clang-O0 clang-O3 wasm

# What no decoder without Draco and libde265 has; refused by their names, which these cases cannot show.
skipped=()
for case in conformance/streams/{draco,texture-*} conformance/refused/{hevc-*,texture-{damaged,picture*}}; do
  skipped+=(--skip "${case#conformance/}")
done
# Their direction is 1e-9 beside a jump of a constant function, less than what a float of pi tells apart.
skipped+=(--without-colours streams/header-order-1)

needs() {  # MACHINE PROGRAM...
  for program in "${@:2}"; do
    command -v "$program" >/dev/null || { echo "$1: skipped, there is no $program (tools/setup.sh machines)"; return 1; }
  done
}

built() {  # MACHINE COMPILER CMAKE_FLAGS...: the program, statically linked but for clang's own machine
  cmake -S . -B "$build/$1" -G Ninja -DCMAKE_CXX_COMPILER="$2" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
    -DSLF_DECODER_ONLY=ON -DSLF_THREADS=OFF -DSLF_C=OFF -DSLF_TESTS=OFF -DSLF_BENCH=OFF -DSLF_WERROR=ON "${@:3}" &&
    cmake --build "$build/$1" --target slf_decoder &&
    "$2" -std=c++20 -O1 -Iinclude conformance/suite_decoder.cpp "$build/$1/libslf_decoder.a" -static -o "$build/$1/suite_decoder.exe"
}

judged() {  # MACHINE BUILD_SECONDS EMULATOR...
  local decoder="${*:3} $build/$1/suite_decoder.exe" began=$SECONDS
  python3 conformance/run.py --json --messages --jobs "$(nproc)" --timeout 300 "${skipped[@]}" \
    --decoder "$decoder decode {in} --dump {out} {options}" --info "$decoder info {in}" \
    --radiance "$decoder radiance {in} {point} {x} {y} {z}" >"$build/$1/report.json" || return 1
  python3 - "$1" "$2" $((SECONDS - began)) "$build/$1/report.json" <<'END'
import json, sys
name, building, decoding, report = *sys.argv[1:4], json.load(open(sys.argv[4]))
print(f'{name}: {report["passed"]} passed, {report["skipped"]} skipped; {report["digests"]} digests; built in {building} s, run in {decoding} s')
END
}

run() {  # MACHINE COMPILER EMULATOR -- CMAKE_FLAGS...: 0 agreed, 1 differs, 77 something is missing
  needs "$1" "$2" ${3:-true} || return 77
  local began=$SECONDS
  mkdir -p "$build"
  built "$1" "$2" "${@:4}" >"$build/$1.log" 2>&1 || { tail -n 20 "$build/$1.log"; echo "$1: does not build"; return 1; }
  judged "$1" $((SECONDS - began)) $3
}

machine() {  # MACHINE
  local code
  case $1 in
    s390x | aarch64 | riscv64) run "$1" "$1-linux-gnu-g++" "qemu-$1-static" -DCMAKE_SYSTEM_NAME=Linux ;;
    i686) run i686 i686-linux-gnu-g++ qemu-i386-static -DCMAKE_SYSTEM_NAME=Linux ;;
    windows)
      # A server that ends with the last program resets the connection of one that begins just then.
      needs windows wineserver || return 77
      mkdir -p "$build/wine"
      export WINEDEBUG=-all WINEPREFIX  # its own: no other program of wine is waited for or ended
      WINEPREFIX=$(realpath "$build/wine")
      wineboot -i >/dev/null 2>&1 && wineserver -w && wineserver -p && wine cmd /c exit
      run windows x86_64-w64-mingw32-g++-posix wine -DCMAKE_SYSTEM_NAME=Windows && code=0 || code=$?
      wineserver -k || true
      return "$code"
      ;;
    gcc-O?) run "$1" g++ "" -DCMAKE_CXX_FLAGS_RELEASE="-${1#*-}" ;;
    clang-O?) run "$1" clang++ "" -DCMAKE_CXX_FLAGS_RELEASE="-${1#*-}" ;;
    wasm)
      needs wasm node || return 77
      [[ -e web/slf.wasm && -e web/slf_scalar.wasm ]] || { echo "wasm: skipped, there is no web/slf.wasm (web/build.sh)"; return 77; }
      (cd web && node --test test/node/conformance.test.js | grep -E '^# (pass|fail|skipped) ') | sed 's/^#/wasm:/' ;;
    *) echo "machines.sh: no machine $1" >&2; return 2 ;;
  esac
}

agreed=0 differing=0 missing=0
for name in "$@"; do
  code=0
  machine "$name" || code=$?
  case $code in
    0) agreed=$((agreed + 1)) ;;
    77) missing=$((missing + 1)) ;;
    *) differing=$((differing + 1)); echo "$name: DIFFERS" ;;
  esac
done
echo "machines: $agreed passed, $differing failed, $missing skipped"
[[ $differing -eq 0 ]] || exit 1
[[ $missing -eq 0 ]] || exit 77
