#!/usr/bin/env bash
# Sets up and runs the whole pipeline on sample scans, or on the files given; results go to out/.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
checkout=$(dirname "${BASH_SOURCE[0]}")/..
"$checkout/scripts/setup.sh"
exec "$checkout/.venv/bin/python" "$checkout/scripts/demo.py" "$@"
