#!/usr/bin/env bash
# Pages of the headers of core/, by Doxygen, in build/api_docs/html/index.html. A warning is an error.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

command -v doxygen >/dev/null || { echo "api_docs: no doxygen: apt-get install doxygen" >&2; exit 1; }
rm -rf build/api_docs
mkdir -p build/api_docs
doxygen docs/Doxyfile
[ -f build/api_docs/html/point__cloud_8h.html ] || { echo "api_docs: found no headers" >&2; exit 1; }
