#!/usr/bin/env bash
# Proves a wheel: in a fresh virtual environment beside the stock PyMeshLab, with nothing of the checkout, the whole
# pipeline runs on FOLDER/scan.ply.
# usage: prove.sh PYTHON FOLDER ARGUMENTS OF PIP INSTALL …
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
readonly python=$1 folder=$2
shift 2
rm -rf "$folder/user"
"$python" -m venv "$folder/user"
"$folder/user/bin/pip" --disable-pip-version-check install -q "$@"
cd "$folder"
export QT_QPA_PLATFORM=offscreen
user/bin/curvature-lines scan.ply -o quads.obj --lines lines.obj --report scan.html --quiet
user/bin/python - <<'PYTHON'
import sys
from pathlib import Path

import pymeshlab
import pymeshlab_curvature_lines as package

found = pymeshlab.MeshSet()
found.load_new_mesh("quads.obj")
assert found.current_mesh().face_number() > 100, "no mesh"
assert "<svg" in Path("scan.html").read_text(), "no report"
assert package.plugin_path().is_relative_to(sys.prefix), package.plugin_path()
# One copy of Qt, the host's, and the libraries that came along.
with open("/proc/self/maps") as maps:
    loaded = {line.split()[-1] for line in maps if ".so" in line}
assert not [name for name in loaded if "libQt5Core" in name and "/user/" not in name], loaded
assert any("pymeshlab_curvature_lines.libs/libgomp-" in name for name in loaded), loaded
print(f"wheel {package.__version__} works:", found.current_mesh().face_number(), "triangles of quads.obj")
PYTHON
