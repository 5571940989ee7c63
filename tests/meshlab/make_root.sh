#!/usr/bin/env bash
# Makes a root of the newest Debian suite with its MeshLab in the folder given, once: minutes and 1.5 GB.
# Status 77: this machine cannot (the last line says why).
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail

readonly suite=sid wanted=2025.07
readonly packages=(
	meshlab              # with its Recommends: without them it greets with a warning about missing plugins
	xvfb openbox xdotool # a screen, a window manager that gives focus, a hand
	libgl1-mesa-dri      # OpenGL in software
	at-spi2-core python3-gi gir1.2-atspi-2.0 dbus-daemon dbus # what stands where on the screen
	python3 imagemagick x11-apps fonts-dejavu-core
)
[ $# -eq 1 ] || { echo "usage: make_root.sh FOLDER" >&2; exit 2; }
readonly root=$(realpath -m "$1")
skip() { echo "SKIPPED: $*" >&2; exit 77; }

version_in() { dpkg-query --admindir="$1/var/lib/dpkg" -W -f '${Version}' meshlab 2>/dev/null || true; }
check_version() {
	local version
	version=$(version_in "$root")
	[[ $version == $wanted* ]] || skip "Debian $suite carries MeshLab '$version', this plugin is for $wanted"
}

if [ -f "$root/.complete" ]; then
	check_version
	exit 0
fi
[ "$(id -u)" -eq 0 ] || skip "a Debian root needs root: run as root"
command -v debootstrap >/dev/null || skip "debootstrap is missing: apt-get install debootstrap"
site=$("$(dirname "${BASH_SOURCE[0]}")/../../scripts/debian_mirror.sh") ||
	skip "no Debian mirror in apt's configuration: this is not a Debian machine"

# Into a folder beside it, so that what stands at the end is whole.
readonly work=$root.making
rm -rf "$work"
mkdir -p "$work"
debootstrap --variant=minbase "$suite" "$work" "$site" >"$work.log" 2>&1 || {
	tail -5 "$work.log" >&2
	skip "debootstrap $suite failed, see $work.log"
}
echo 'Acquire::Check-Valid-Until "false";' >"$work/etc/apt/apt.conf.d/99old-mirror"
{
	chroot "$work" apt-get update -q &&
		# MeshLab alone with what it recommends; the tools with what they need.
		chroot "$work" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --install-recommends "${packages[0]}" &&
		chroot "$work" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${packages[@]:1}" &&
		chroot "$work" apt-get clean
} >>"$work.log" 2>&1 || {
	tail -5 "$work.log" >&2
	echo "installing MeshLab in the root failed, see $work.log" >&2
	exit 1
}
touch "$work/.complete"
rm -rf "$root"
mv "$work" "$root"
check_version
echo "MeshLab $(version_in "$root") in $root"
