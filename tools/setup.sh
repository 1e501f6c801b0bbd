#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages that building needs. An argument adds others: `web` those that
# web/build_wasm.sh and its tests need, `lab` these and those of all tests and of the RD laboratory
# (tools/rd), `site` those of tools/site.sh, `text` those of tools/text.sh, `machines` those of conformance/machines.sh (cross
# compilers, qemu, wine) and .ci/bare.sh.
# Quick when all are there; safe to repeat. As root, or through sudo.
set -euo pipefail

packages=(
  g++ clang cmake ninja-build pkg-config
  zlib1g-dev libpng-dev libjpeg62-turbo-dev libdraco-dev
  libde265-dev libzstd-dev libwebp-dev libzip-dev
  libeigen3-dev libnanoflann-dev nlohmann-json3-dev libcli11-dev
  python3 python3-numpy
)
if [[ "${1:-}" == web || "${1:-}" == lab ]]; then
  packages+=(clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 wasi-libc binaryen brotli xz-utils)
  # Any node from 18 on will do, wherever it came from.
  command -v node >/dev/null || packages+=(nodejs)
  command -v npm >/dev/null || packages+=(npm)
fi
if [[ "${1:-}" == lab ]]; then
  packages+=(clang-tidy libclang-rt-dev libgtest-dev libgmock-dev libx265-dev libaom-dev snakemake python3-scipy python3-matplotlib
    pybind11-dev python3-venv mypy  # bindings/python/
    doxygen dpkg-dev man-db file shared-mime-info libglib2.0-bin lintian  # packages, reference, man pages, file types
    locales  # tests/tools/locale_test.py
    chromium)  # web/test/browser
fi
if [[ "${1:-}" == site || "${1:-}" == lab ]]; then
  packages+=(mkdocs mkdocs-material codespell)
fi
if [[ "${1:-}" == text || "${1:-}" == lab ]]; then
  packages+=(pandoc weasyprint fonts-dejavu-core fonts-dejavu-extra)  # tools/text.sh
fi
if [[ "${1:-}" == machines ]]; then
  packages+=(qemu-user-static g++-{s390x,aarch64,riscv64,i686}-linux-gnu g++-mingw-w64-x86-64-posix wine wine64 debootstrap)
fi

missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null)" == "install ok installed" ]] ||
    missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "setup.sh: run as root to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
