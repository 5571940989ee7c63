#!/usr/bin/env bash
# Makes a root of the newest Debian suite with its MeshLab in the folder given, once: minutes and 1.5 GB.
# Status 77: this machine cannot (the last line says why).
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail

readonly suite=sid wanted=2025.07
readonly tools=(
	xvfb openbox xdotool # a screen, a window manager that gives focus, a hand
	libgl1-mesa-dri      # OpenGL in software
	at-spi2-core python3-gi gir1.2-atspi-2.0 dbus-daemon dbus # what stands where on the screen
	python3 imagemagick x11-apps fonts-dejavu-core
)
[ $# -eq 1 ] || { echo "usage: make_root.sh FOLDER" >&2; exit 2; }
readonly root=$(realpath -m "$1")
skip() { echo "SKIPPED: $*" >&2; exit 77; }

# MeshLab with its Recommends: without them it greets with a warning about missing plugins. The tools with what they need.
"$(dirname "${BASH_SOURCE[0]}")/../../scripts/make_debian_root.sh" "$root" "$suite" \
	"--install-recommends meshlab" "--no-install-recommends ${tools[*]}"

version=$(dpkg-query --admindir="$root/var/lib/dpkg" -W -f '${Version}' meshlab 2>/dev/null || true)
[[ $version == $wanted* ]] || skip "Debian $suite carries MeshLab '$version', this plugin is for $wanted"
echo "MeshLab $version in $root"
