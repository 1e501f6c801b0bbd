#!/usr/bin/env bash
# Installs the Debian packages that building and testing need. Quick when all are there; safe to
# repeat. As root, or through sudo.
set -euo pipefail

packages=(
  g++ clang cmake ninja-build pkg-config
  zlib1g-dev libpng-dev libjpeg62-turbo-dev libdraco-dev
  libeigen3-dev libnanoflann-dev nlohmann-json3-dev libcli11-dev
  libgtest-dev libgmock-dev
  python3 python3-numpy
)

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
