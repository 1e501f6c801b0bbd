#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Integer coding gives the same bytes for gcc and clang, -O0 and -O3: builds the generator of the golden
# streams with each and compares all it writes with the goldens.
#   compilers.sh ["COMPILER LEVEL"...]   (default: all four)
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# With x265 and libde265 where they are there; else the generator leaves textures out.
video_flags="" video_libraries="" excluded=()
if pkg-config --exists x265 libde265; then
  video_flags="-DSLF_WITH_HEVC=1 -DSLF_WITH_X265=1" video_libraries="-lx265 -lde265"
else
  excluded=(--exclude 'texture-*')
fi
# As with CMAKE_UNITY_BUILD, up to twelve files of a folder of the library are one for the compiler.
sources="$work/sources"
mkdir "$sources"
together() {  # FILES FOLDER...
  for folder in "${@:2}"; do
    ls $folder/*.cpp | grep -v -e parallel_serial -e left_out -e suite_decoder | sed 's/.*/#include "&"/' |
      split -l "$1" --additional-suffix=.cpp - "$sources/${folder//\//_}_"
  done
}
together 12 base bitstream geometry attributes codec codec/decoder codec/encoder codec/stream lightfield attributes/texture attributes/video
together 1 conformance  # its files use the same short names
[[ $# -gt 0 ]] || set -- "g++ -O0" "g++ -O3" "clang++ -O0" "clang++ -O3"
for build in "$@"; do
  objects="$work/${build// /}"
  mkdir "$objects"
  ls "$sources" | xargs -P "$(nproc)" -I{} $build -std=c++20 -DSLF_WITH_DRACO=1 $video_flags -Iinclude -I. \
    -isystem /usr/include/eigen3 -c "$sources/{}" -o "$objects/{}.o"
  ${build% *} "$objects"/*.o -o "$objects/generate" -ldraco $video_libraries -lz -pthread
  "$objects/generate" "$work/made"
  diff -r "${excluded[@]}" "$work/made/streams" conformance/streams
  diff -r "${excluded[@]}" "$work/made/refused" conformance/refused
  rm -rf "$work/made" "$objects"
  echo "same bytes: $build"
done
echo "$# passed, 0 failed"
