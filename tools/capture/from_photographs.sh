#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# From a folder of photographs to a light field: docs/from-photographs.md
#
#     tools/capture/from_photographs.sh PHOTOS -o x.slf [--html x.html] [--work DIR] [--cameras one|each]
#                                       [--matcher exhaustive|sequential] [--slf PROGRAM] [-- OPTIONS OF SLF ENCODE]
#
# Structure from motion by COLMAP (Debian's package; on the CPU), then slf encode, which trains geometry from the photographs,
# then the page. Steps whose results are in the work directory (default: x.slf.work) are not done again. PHOTOS may be a capture
# already: a COLMAP model, cameras.json and what else slf encode reads; then only encode and page are left.
set -euo pipefail

fail() { echo "from_photographs.sh: $*" >&2; exit 2; }
usage() { sed -n '2,6p' "$0" | sed 's/^# \{0,1\}//' >&2; exit 2; }

photos='' output='' html='' work='' cameras=one matcher=exhaustive slf='' encode=()
while [ $# -gt 0 ]; do
  case "$1" in
    -o) output=${2:?}; shift 2 ;;
    --html) html=${2:?}; shift 2 ;;
    --work) work=${2:?}; shift 2 ;;
    --cameras) cameras=${2:?}; shift 2 ;;
    --matcher) matcher=${2:?}; shift 2 ;;
    --slf) slf=${2:?}; shift 2 ;;
    --) shift; encode=("$@"); break ;;
    -*) usage ;;
    *) [ -z "$photos" ] || usage; photos=$1; shift ;;
  esac
done
[ -n "$photos" ] && [ -n "$output" ] || usage
[ -d "$photos" ] || fail "$photos: no such folder"
case "$cameras" in one) single=1 ;; each) single=0 ;; *) fail "--cameras $cameras: one or each" ;; esac
case "$matcher" in exhaustive | sequential) ;; *) fail "--matcher $matcher: exhaustive or sequential" ;; esac
here=$(cd "$(dirname "$0")/../.." && pwd)
[ -n "$slf" ] || slf=$(command -v slf || echo "$here/build/bin/slf")
[ -x "$slf" ] || fail "$slf: not there (--slf PROGRAM; tools/demo.sh builds one)"
work=${work:-$output.work}

# What slf encode finds in a folder: docs/captures.md.
is_capture() {
  local name
  for name in cameras.json cameras.bin cameras.txt transforms.json transforms_train.json index.cams cameras.xml \
    bundle.out bundle.rd.out bundle/bundle.out sfm_data.json {.,colmap}/sparse/{,0/}cameras.{bin,txt} colmap/cameras.{bin,txt}; do
    [ ! -e "$1/$name" ] || return 0
  done
  compgen -G "$1/sparse/[0-9]*/cameras.*" >/dev/null
}

# How many photographs have one of the extensions.
count_of() { find -L "$photos" -maxdepth 1 -type f | grep -icE "\\.($1)\$" || true; }

# A step, its time, and its log where it fails.
step() {
  local name=$1 log=$work/$1.log begin=$SECONDS
  shift
  if [ -e "$work/$name.done" ]; then echo "$name: done before"; return; fi
  if ! "$@" >"$log" 2>&1; then tail -5 "$log" >&2; fail "$name failed: $log"; fi
  touch "$work/$name.done"
  echo "$name: $((SECONDS - begin)) s"
}

structure_from_motion() {
  local count other
  other=$(count_of 'tiff?|hei[cf]|webp|avif|dng|cr[23]|nef|arw')
  [ "$other" -eq 0 ] || fail "$photos: $other photographs are TIFF, HEIC or raw, which slf does not read: convert them to PNG or JPEG in a" \
    "folder of its own (mogrify -path OTHER -format png; heif-convert a.heic a.jpg), or move them away"
  count=$(count_of 'jpe?g|png|ppm|pgm')
  [ "$count" -ge 8 ] || fail "$photos: $count photographs; 8 are the least, 40 and more are good"
  [ "$matcher" = exhaustive ] && [ "$count" -gt 400 ] && echo "exhaustive matching of $count photographs takes long: --matcher sequential for a walk around" >&2
  command -v colmap >/dev/null || fail "colmap is missing: apt-get install colmap (Debian, Ubuntu)"
  mkdir -p "$work/sparse"
  export QT_QPA_PLATFORM=offscreen
  step features colmap feature_extractor --database_path "$work/database.db" --image_path "$photos" \
    --ImageReader.single_camera "$single" --SiftExtraction.use_gpu 0
  step matches colmap "${matcher}_matcher" --database_path "$work/database.db" --SiftMatching.use_gpu 0
  step mapping colmap mapper --database_path "$work/database.db" --image_path "$photos" --output_path "$work/sparse"
  [ -d "$work/sparse/0" ] || fail "no model came out: photographs overlap too little, or show too little texture ($work/mapping.log)"
}

if is_capture "$photos"; then
  capture=$photos
  images=()
else
  mkdir -p "$work"
  work=$(cd "$work" && pwd) photos=$(cd "$photos" && pwd)
  structure_from_motion
  capture=$work
  images=(--images "$photos")
fi
begin=$SECONDS
"$slf" encode "$capture" "${images[@]}" -o "$output" "${encode[@]}"
echo "encode: $((SECONDS - begin)) s"
[ -z "$html" ] || "$slf" html "$output" -o "$html"
