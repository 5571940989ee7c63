#!/usr/bin/env bash
# Sets up, checks the format of every file and runs every test: core/ under ctest, then the real plugin in the real
# PyMeshLab under pytest.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh

failed=0
scripts/check_format.sh || failed=1
ctest --preset release --parallel "$(nproc)" || failed=1
.venv/bin/python -m pytest tests/python || failed=1
exit $failed
