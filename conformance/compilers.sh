#!/usr/bin/env bash
# Integer coding gives the same bytes for gcc and clang, -O0 and -O3: builds the generator of the golden
# streams with each and compares all it writes with the goldens.
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
sources="conformance/*.cpp bitstream/*.cpp geometry/*.cpp attributes/*.cpp codec/assemble.cpp codec/base_*.cpp codec/coded_unit.cpp
  codec/component_decoder.cpp codec/decode.cpp codec/node_voxels.cpp codec/read_info.cpp codec/scene_*.cpp codec/truncate.cpp
  codec/derive_transforms.cpp codec/sequence*.cpp codec/slice_*.cpp codec/pack*.cpp codec/texture_*.cpp codec/transform_units.cpp lightfield/basis*.cpp lightfield/harmonics.cpp texture/*.cpp video/picture.cpp video/hevc_*.cpp"
for compiler in g++ clang++; do
  for level in -O0 -O3; do
    objects="$work/$compiler$level"
    mkdir "$objects"
    printf '%s\n' $sources | xargs -P "$(nproc)" -I{} sh -c \
      "$compiler -std=c++20 $level -DSLF_WITH_DRACO=1 $video_flags -Iinclude -I. -isystem /usr/include/eigen3 -c {} -o $objects/\$(echo {} | tr / _).o"
    "$compiler" "$objects"/*.o -o "$objects/generate" -ldraco $video_libraries -lz -pthread
    "$objects/generate" "$work/made"
    diff -r "${excluded[@]}" "$work/made/streams" conformance/streams
    diff -r "${excluded[@]}" "$work/made/refused" conformance/refused
    rm -rf "$work/made"
    echo "same bytes: $compiler $level"
  done
done
echo "4 passed, 0 failed"
