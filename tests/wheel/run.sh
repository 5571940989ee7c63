#!/usr/bin/env bash
# Builds the wheel and proves it in a bare Debian root: Python, and the libraries that PyMeshLab itself needs; no
# compiler, no package of this project, no network. Status 77: skipped where there is no root or debootstrap.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
readonly root=$PWD/build/wheel-root stage=/opt/wheel

scripts/wheel.sh
# This machine's suite: its glibc is the oldest that what is built here is sure to run with.
# shellcheck source=/dev/null
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
scripts/make_debian_root.sh "$root" "$suite" "--no-install-recommends python3-venv libgl1 libopengl0"

version=$(chroot "$root" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
rm -rf "$root$stage"
mkdir -p "$root$stage/wheels"
.venv/bin/python -m pip --disable-pip-version-check download -q --only-binary=:all: --python-version "$version" \
	--dest "$root$stage/wheels" dist/*.whl
cp sample_data/helicoid_1730_noise0.5_outliers5.ply "$root$stage/scan.ply"
cp tests/wheel/prove.sh "$root$stage"
chroot "$root" bash -euc '! type -P cc c++ gcc g++ clang cmake qmake git'
scripts/in_debian_root.sh "$root" unshare --net bash "$stage/prove.sh" python3 "$stage" \
	--no-index --find-links "$stage/wheels" pymeshlab-curvature-lines
