#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the text of the format as one HTML page and as a PDF, contents and figures inside, in build/text.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh text
mkdir -p build/text
pandoc spec/slf-bitstream.md -f gfm -t html5 --standalone --self-contained --resource-path=spec:tools/site \
  --css tools/site/text.css -M pagetitle="The .slf bitstream" -M lang=en -o build/text/slf-bitstream.html
weasyprint --quiet build/text/slf-bitstream.html build/text/slf-bitstream.pdf
echo "text.sh: build/text/slf-bitstream.html, build/text/slf-bitstream.pdf"
