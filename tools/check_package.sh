#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the Debian packages of a build, installs them into an empty root with dpkg, and there: runs the
# program, reads its man pages, completes a command line, builds a C and a C++ program with
# pkg-config and docs/examples/ with find_package; then removes them and looks that nothing is left.
#   check_package.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/.."
source=$PWD
build=$(realpath -- "${1:-build}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root

say() { echo "check_package: $*" >&2; }
fail() { say "FAILED: $*"; exit 1; }

say "making packages, twice: the same bytes"
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 0)}
(cd "$build" && cpack -G DEB -B "$work/made" >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; exit 1; }
packages=("$work"/made/*.deb)
ls -l "${packages[@]}" >&2
(cd "$build" && cpack -G DEB -B "$work/again" >/dev/null 2>&1)
for package in "${packages[@]}"; do
  cmp "$package" "$work/again/${package##*/}" || fail "${package##*/} is not the same bytes when it is made again"
done
rm -r "$work/again"

say "installing into an empty root"
mkdir -p "$root/var/lib/dpkg/info" "$root/var/lib/dpkg/updates"
: >"$root/var/lib/dpkg/status"
# Scripts of packages run outside of the root, which has no shell, with an ldconfig that does nothing.
mkdir "$work/bin"
printf '#!/bin/sh\n' >"$work/bin/ldconfig" && chmod +x "$work/bin/ldconfig"
export PATH=$work/bin:$PATH:/usr/sbin:/sbin
in_root=(dpkg --root="$root" --force-not-root --force-script-chrootless --force-depends --force-bad-path --log=/dev/null)
"${in_root[@]}" -i "${packages[@]}" >"$work/dpkg.log" 2>&1 || { cat "$work/dpkg.log"; exit 1; }
libdir=$(dirname "$(find "$root" -name 'libslf_decoder.a')")
export LD_LIBRARY_PATH=$libdir

say "multiarch"
triplet=$(sed -n 's/^CMAKE_INSTALL_LIBDIR:PATH=lib\/\(.*-.*\)/\1/p' "$build/CMakeCache.txt")
for package in "${packages[@]}"; do
  wanted=same
  [[ ${package##*/} == lib* ]] || wanted=foreign
  [[ -n $triplet || $wanted == foreign ]] || continue  # built for one place for all architectures
  [[ $(dpkg-deb -f "$package" Multi-Arch) == "$wanted" ]] || fail "${package##*/} is not Multi-Arch: $wanted"
  [[ $wanted == foreign ]] || ! dpkg-deb -c "$package" | grep -v "lib/$triplet/" | grep -E '\.(so|a|pc|cmake)' ||
    fail "${package##*/} has libraries outside of lib/$triplet"
done
[[ -z $triplet || -e $libdir/libslf_c.so && $libdir == */usr/lib/$triplet ]] || fail "libraries are in $libdir"

say "the program"
slf=$root/usr/bin/slf
cd "$work"
"$slf" --version
"$slf" synth can -o tiny --size 48x48 --points 1500 --circles 3 --per-circle 8 --quiet
"$slf" encode tiny -o tiny.slf --effort 1 --quiet
"$slf" info tiny.slf >/dev/null
"$slf" export tiny.slf -o tiny.spz --quiet

say "man pages and completion"
for page in slf slf-encode slf-export; do
  file=$(find "$root/usr/share/man/man1" -name "$page.1*")
  [[ -n $file ]] || fail "no man page $page"
  case $file in *.gz) zcat "$file" ;; *) cat "$file" ;; esac >"$page.1"
  if command -v man >/dev/null; then
    MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page.1" 2>"$page.warnings" >/dev/null
    [[ ! -s $page.warnings ]] || { cat "$page.warnings"; fail "man page $page"; }
  fi
done
for section in DESCRIPTION 'EXIT STATUS' EXAMPLES; do
  grep -q "^\.SH $section" slf-export.1 || fail "slf-export.1 has no $section"
done
grep -q 'target\\-psnr' slf-encode.1 || fail "slf-encode.1 lacks an option"
completed=$(bash -c 'source "$1"; COMP_WORDS=(slf export --for); COMP_CWORD=2; _slf; echo "${COMPREPLY[@]}"' \
  bash "$root/usr/share/bash-completion/completions/slf")
[[ $completed == --format ]] || fail "completion of --for is '$completed'"

say "types of files"
if command -v file >/dev/null; then
  [[ $(file -b -m "$root/usr/share/slf/slf.magic" --mime-type tiny.slf) == model/vnd.slf ]] || fail "file does not know tiny.slf"
fi
if command -v update-mime-database >/dev/null && command -v gio >/dev/null; then
  mkdir -p data/mime/packages
  cp "$root/usr/share/mime/packages/slf.xml" data/mime/packages/
  update-mime-database data/mime
  cp tiny.slf nameless
  XDG_DATA_HOME=$work/data gio info -a standard::content-type nameless | grep -q 'model/vnd\.slf' || fail "gio does not know tiny.slf"
fi

say "thumbnails"
exec=$(sed -n 's/^Exec=//p' "$root/usr/share/thumbnailers/slf.thumbnailer")
exec=${exec/#slf/"$slf"} exec=${exec//%i/tiny.slf} exec=${exec//%o/thumbnail.png}
${exec//%s/128}
file thumbnail.png | grep -q '128 x 128' || fail "a thumbnail is not 128 pixels wide"

if command -v lintian >/dev/null; then
  say "lintian"
  lintian --allow-root --fail-on error --suppress-tags bogus-mail-host "${packages[@]}" >&2 || fail "lintian has errors"
fi

say "a C program by pkg-config"
export PKG_CONFIG_PATH=$libdir/pkgconfig
cat >use.c <<'C'
#include <slf/slf.h>
#include <stdio.h>
#include <stdlib.h>
int main(int argc, char** argv) {
  static unsigned char bytes[1 << 24];
  slf_error error = SLF_ERROR_INIT;
  slf_stream* stream = NULL;
  slf_info info = {sizeof(slf_info)};
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
  if (slf_open(bytes, size, NULL, &stream, &error) != SLF_OK ||
      slf_get_info(stream, &info, &error) != SLF_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  printf("C: %lu points, library %s\n", (unsigned long)info.points, slf_version());
  slf_release_stream(stream);
  fclose(file);
  return 0;
}
C
cc -std=c99 use.c -o use_c $(pkg-config --cflags --libs slf)
./use_c tiny.slf

say "a C++ program by pkg-config"
c++ -std=c++20 "$source/docs/examples/decode_points.cpp" -o use_cxx $(pkg-config --cflags --libs slf-cxx)
./use_cxx tiny.slf >/dev/null

say "docs/examples/ by find_package"
cmake -S "$source/docs/examples" -B examples -DCMAKE_PREFIX_PATH="$root/usr" >/dev/null
cmake --build examples >/dev/null
examples/decode_points tiny.slf >/dev/null

say "removing"
names=$("${in_root[@]}" --get-selections | cut -f1)
"${in_root[@]}" --purge $names >"$work/dpkg.log" 2>&1 || { cat "$work/dpkg.log"; exit 1; }
left=$(find "$root" -path "$root/var" -prune -o -type f -print -o -type l -print)
[[ -z $left ]] || fail "left behind: $left"
say "all well"
