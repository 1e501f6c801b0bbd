#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws six scenes, codes them and makes a live page of each in build/gallery; tools/site.sh takes them in.
# Nothing in them is anybody else's. About five minutes of one core; an argument is the size of the photographs.
set -euo pipefail
cd "$(dirname "$0")/../.."

slf=${SLF_PROGRAM:-build/bin/slf}
size=${1:-256x256}
out=build/gallery
mkdir -p "$out/captures"

# NAME SCENE OPTIONS-OF-SYNTH | OPTIONS-OF-ENCODE | WHAT IT SHOWS
scenes=(
  "can can|| A can: lettering, rings and lamps that move over lacquer."
  "die die|| A translucent die whose faces mirror a room."
  "vase vase|| A vase: curves, and a glaze that depends on the direction."
  "splats vase|--surface splats| The same vase as Gaussian splats."
  "walk walk --frames 8 --circles 4 --per-circle 6|| A figure that walks: eight frames in one file."
  "turn turn --frames 8 --circles 4 --per-circle 6|| A can that turns under lamps that stand: eight frames."
)
: >"$out/list.md"
for entry in "${scenes[@]}"; do
  IFS='|' read -r drawn encode text <<<"$entry"
  read -r name scene synth <<<"$drawn"
  # shellcheck disable=SC2086  # options are words
  [[ -e $out/captures/$name ]] || "$slf" synth "$scene" --size "$size" $synth -o "$out/captures/$name" --quiet
  # shellcheck disable=SC2086
  [[ -e $out/$name.slf ]] || "$slf" encode "$out/captures/$name" $encode -o "$out/$name.slf" --quiet
  "$slf" html "$out/$name.slf" -o "$out/$name.html" --title "$name" --quiet
  "$slf" render "$out/$name.slf" --azimuth 30 --elevation 20 --size 320x320 -o "$out/$name.png" --quiet
  printf '[![%s](%s.png)](%s.html)\n\n%s The file has %s bytes, its page %s.\n\n' "$name" "$name" "$name" "${text# }" \
    "$(stat -c %s "$out/$name.slf")" "$(stat -c %s "$out/$name.html")" >>"$out/list.md"
  printf '    slf synth %s -o %s\n    slf encode %s -o %s.slf\n    slf html %s.slf -o %s.html\n\n' \
    "$scene --size $size${synth:+ $synth}" "$name" "$name${encode:+ $encode}" "$name" "$name" "$name" >>"$out/list.md"
done
echo "gallery.sh: $out"
