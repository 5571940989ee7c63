#!/usr/bin/env bash
# Runs a command inside a root that make_debian_root.sh made, with nothing of this machine's environment. In a
# namespace of its own: whatever it starts ends with it, and nothing stays mounted. Needs root.
# usage: in_debian_root.sh FOLDER COMMAND [ARGUMENT …]
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
exec unshare --mount --pid --fork --kill-child bash -euc '
	mount -t proc proc "$0/proc"
	mkdir -p "$0/dev/shm" && mount -t tmpfs tmpfs "$0/dev/shm"
	mount -t tmpfs tmpfs "$0/tmp" && mkdir -m 700 "$0/tmp/home" "$0/tmp/run"
	exec chroot "$0" env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin LC_ALL=C.UTF-8 LIBGL_ALWAYS_SOFTWARE=1 \
		HOME=/tmp/home XDG_RUNTIME_DIR=/tmp/run XDG_DATA_HOME=/tmp/home/data "$@"' "$@"
