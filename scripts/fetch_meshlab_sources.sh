#!/usr/bin/env bash
# Unpacks the MeshLab 2025.07 headers and vcglib into the folder given as first argument, once.
# Order: the distribution's source package (through apt, its address is never written down), then upstream git.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail

readonly version=2025.07
readonly tarball=meshlab_${version}~dfsg.orig.tar.xz
readonly sha256=d22c98d362f2a284e481af8dbfc272b2222f5b9c67b3cf8bec57d1c3161886f4
readonly upstream=https://github.com/cnr-isti-vclab/meshlab
[ $# -eq 1 ] || { echo "usage: fetch_meshlab_sources.sh FOLDER" >&2; exit 2; }
readonly target=$(realpath -m "$1")

complete() { [ -f "$1/src/common/plugins/interfaces/filter_plugin.h" ] && [ -d "$1/src/vcglib/vcg" ]; }

complete "$target" && exit 0
mkdir -p "$(dirname "$target")"
work=$(mktemp -d "$(dirname "$target")/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
# apt drops its privileges to a user of its own to download, who must be able to get here.
chmod 755 "$work"

from_distribution() {
	local site keyring=/usr/share/keyrings/debian-archive-keyring.gpg
	[ -x /usr/lib/apt/apt-helper ] && [ -f "$keyring" ] || return 1
	site=$("$(dirname "${BASH_SOURCE[0]}")/debian_mirror.sh") || return 1

	# A package index of our own, so that neither the machine's lists nor its sources change.
	mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
	echo "deb-src [signed-by=$keyring] $site sid main" >"$work/sources.list"
	local apt=(-qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=/dev/null
		-o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache"
		-o Acquire::Check-Valid-Until=false -o APT::Sandbox::User="$(id -un)")
	apt-get "${apt[@]}" update >&2 || return 1
	local uri
	uri=$(apt-get "${apt[@]}" source --print-uris --download-only meshlab 2>/dev/null |
		awk -v file="$tarball" -F"'" '$3 ~ "^ " && index($3, file) { print $2; exit }')
	[ -n "$uri" ] || return 1
	/usr/lib/apt/apt-helper "${apt[@]}" download-file "$uri" "$work/$tarball" "SHA256:$sha256" >&2 || return 1
	echo "$sha256  $work/$tarball" | sha256sum --check --quiet >&2 || return 1
	mkdir "$work/tree"
	# Only the headers: the plugin is linked with the host's own library.
	tar -xJf "$work/$tarball" -C "$work/tree" --strip-components=1 --wildcards '*/src/common' '*/src/vcglib'
}

from_git() {
	command -v git >/dev/null || return 1
	rm -rf "$work/tree"
	GIT_TERMINAL_PROMPT=0 git clone --quiet --depth 1 --branch "MeshLab-$version" "$upstream" "$work/tree" >&2 &&
		git -C "$work/tree" submodule --quiet update --init --depth 1 src/vcglib >&2
}

if { from_distribution || from_git; } && complete "$work/tree"; then
	# Somebody else may have been faster: theirs is as good.
	mv -T "$work/tree" "$target" 2>/dev/null || complete "$target"
else
	echo "MeshLab $version sources not found: neither the distribution's source package nor $upstream can be" \
		"reached; unpack them yourself and pass -DMESHLAB_SOURCE_DIR=FOLDER" >&2
	exit 1
fi
