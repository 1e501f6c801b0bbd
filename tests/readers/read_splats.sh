#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# read_splats.mjs where there is node; else 77 and a line.
#   tests/readers/read_splats.sh DIRECTORY
set -euo pipefail
command -v node >/dev/null || { echo "read_splats: skipped, there is no node (tools/setup.sh web)"; exit 77; }
exec node "$(dirname "$0")/read_splats.mjs" "$@"
