#!/usr/bin/env bash
# Makes a checkout ready: system packages, .venv, MeshLab headers, one build, the Python package in .venv.
# Safe to run again and quick when nothing is missing. scripts/demo.sh and scripts/test.sh begin with it.
# `scripts/setup.sh --configure` stops before the build, for those who build in another way.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
	g++ cmake ninja-build python3-venv xz-utils
	qtbase5-dev libqt5opengl5-dev libglew-dev
	libeigen3-dev libnanoflann-dev libcgal-dev liblbfgspp-dev libdlib-dev libxsimd-dev
	libgtest-dev libqhull-dev
	# What pymeshlab needs to load, and pictures to be drawn without a screen.
	libgl1 libopengl0 libglu1-mesa libegl1 libgl1-mesa-dri libx11-6 libxrender1
)

fail() { echo "setup: $*" >&2; exit 1; }

case "${1-}" in
	"" | --configure) ;;
	*) fail "unknown argument $1; the only one is --configure" ;;
esac

install_packages() {
	command -v dpkg-query >/dev/null || return 0 # another distribution: configuring names what is missing
	local package missing=()
	for package in "${packages[@]}"; do
		[ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
	done
	[ ${#missing[@]} -gt 0 ] || return 0
	local root=()
	[ "$(id -u)" -eq 0 ] || { command -v sudo >/dev/null && root=(sudo); } || fail "needs root: apt-get install ${missing[*]}"
	echo "setup: installing ${missing[*]}"
	{ "${root[@]}" apt-get update -q && "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
		apt-get install -q -y --no-install-recommends "${missing[@]}"; } >/dev/null || fail "failed: apt-get install ${missing[*]}"
}

make_venv() {
	.venv/bin/python -c '' 2>/dev/null && return 0
	local python
	# The versions that pymeshlab 2025.7 is published for, newest first.
	for python in python3.14 python3.13 python3.12 python3.11 python3.10 python3 /usr/bin/python3; do
		"$python" -c 'import ensurepip, sys, venv; sys.exit(not (3, 10) <= sys.version_info < (3, 15))' 2>/dev/null || continue
		echo "setup: making .venv with $("$python" --version)"
		"$python" -m venv --clear .venv && return 0
	done
	fail "no Python 3.10 to 3.14 with venv: apt-get install python3-venv"
}

pip() { .venv/bin/python -m pip --disable-pip-version-check "$@" || fail "failed: pip $*"; }

install_packages
make_venv
pip install -q 'scikit-build-core>=0.10' pymeshlab==2025.7.post1

cmake --preset release >/dev/null || fail "configuring failed, see above"
[ "${1-}" != --configure ] || exit 0
cmake --build --preset release --parallel "$(nproc)"
# The package takes the plugin out of the tree just built; nothing is compiled twice.
pip install -q --no-build-isolation --config-settings build-dir=build/release '.[render,test]'
