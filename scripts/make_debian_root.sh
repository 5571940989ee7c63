#!/usr/bin/env bash
# Makes a Debian root in the folder given, once, from the mirror of this machine: the least that boots apt, then every
# line of arguments to "apt-get install" in turn. Status 77: this machine cannot (the last line says why).
# usage: make_debian_root.sh FOLDER SUITE 'ARGUMENTS OF APT-GET INSTALL' …
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
[ $# -ge 2 ] || { sed -n '4s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2; }
readonly root=$(realpath -m "$1") suite=$2
shift 2
skip() { echo "SKIPPED: $*" >&2; exit 77; }

[ "$(id -u)" -eq 0 ] || skip "a Debian root needs root: run as root"
[ ! -f "$root/.complete" ] || exit 0
command -v debootstrap >/dev/null || skip "debootstrap is missing: apt-get install debootstrap"
site=$("$(dirname "${BASH_SOURCE[0]}")/debian_mirror.sh") ||
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
fill() {
	chroot "$work" apt-get update -q || return
	local arguments
	for arguments in "$@"; do
		# shellcheck disable=SC2086 # several words
		chroot "$work" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y $arguments || return
	done
	chroot "$work" apt-get clean
}
fill "$@" >>"$work.log" 2>&1 || {
	tail -5 "$work.log" >&2
	echo "installing packages in the root failed, see $work.log" >&2
	exit 1
}
touch "$work/.complete"
rm -rf "$root"
mv "$work" "$root"
