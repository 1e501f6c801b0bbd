#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the site of all documents in build/site/html, searchable, without a network. Any static server
# shows it: python3 -m http.server -d build/site/html
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh site
rm -rf build/site
mkdir -p build/site
/usr/bin/python3 tools/site/stage_pages.py . build/site/pages
mkdocs build --quiet -f tools/site/mkdocs.yml
echo "site.sh: build/site/html/docs/index.html"
