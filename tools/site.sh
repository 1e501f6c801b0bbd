#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the site of all documents in build/site/html, searchable, without a network. Any static server
# shows it: python3 -m http.server -d build/site/html
# With the help of every verb of build/bin/slf, and the reference of the headers where doxygen is there.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh site
rm -rf build/site
mkdir -p build/site
/usr/bin/python3 tools/site/stage_pages.py . build/site/pages
mkdocs build --quiet -f tools/site/mkdocs.yml
if command -v doxygen >/dev/null; then
  doxygen -q docs/Doxyfile
  cp -r build/doxygen/html build/site/html/headers
fi
echo "site.sh: build/site/html/docs/index.html"
