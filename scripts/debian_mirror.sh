#!/usr/bin/env bash
# Prints the Debian mirror of this machine's own apt configuration: no address is ever written down in this checkout.
# Fails where there is none (no apt, or another distribution).
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
command -v apt-get >/dev/null
site=$(apt-get indextargets --format '$(SITE)|$(COMPONENT)|$(ORIGIN)|$(CODENAME)' 'Created-By: Packages' |
	awk -F'|' '$2 == "main" && $3 == "Debian" && $4 !~ /security/ && !found { print $1; found = 1 }')
[ -n "$site" ]
echo "$site"
