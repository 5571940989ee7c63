#!/usr/bin/env bash
# Compares every C++ file with .clang-format and every Python file with the rules of ruff in pyproject.toml.
# Names the files that differ and fails; `scripts/check_format.sh --fix` rewrites them instead.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "check_format: $*" >&2; exit 1; }

case "${1-}" in
	"") fix= ;;
	--fix) fix=1 ;;
	*) fail "unknown argument $1; the only one is --fix" ;;
esac

# Every version of these tools formats a little differently: one is pinned in pyproject.toml, extra "test".
# Where there is no .venv, they are taken from the PATH.
PATH="$PWD/.venv/bin:$PATH"
for tool in clang-format ruff; do
	pinned=$(sed -n "s/.*\"$tool==\([0-9.]*\)\".*/\1/p" pyproject.toml)
	[ -n "$pinned" ] || fail "pyproject.toml pins no version of $tool"
	command -v "$tool" >/dev/null || fail "no $tool: run scripts/setup.sh, or pip install $tool==$pinned"
	"$tool" --version | grep -qwF "$pinned" || fail "needs $tool $pinned and found $("$tool" --version): pip install $tool==$pinned"
done

# Not from git: a continuous integration may work on an archive of the sources.
mapfile -t sources < <(find . \( -path './.*' -o -path ./build -o -path ./dist -o -path ./out \) -prune -o \
	-type f \( -name '*.h' -o -name '*.cpp' \) -print)
[ ${#sources[@]} -gt 0 ] || fail "found no C++ file"

if [ -n "$fix" ]; then
	clang-format -i "${sources[@]}"
	ruff check --quiet --fix-only .
	ruff format --quiet .
fi
failed=0
clang-format --dry-run --Werror --ferror-limit=1 "${sources[@]}" || failed=1
ruff check --quiet . || failed=1
ruff format --quiet --check . || failed=1
[ $failed -eq 0 ] || fail "the files above differ; scripts/check_format.sh --fix rewrites what a machine can"
