#!/usr/bin/env bash
# Runs clang-tidy with the short list of .clang-tidy over the C++ files of the rings and of the tests, or over those
# named. Takes their flags from build/release, so scripts/setup.sh comes first. Not part of scripts/test.sh, because it
# takes as long as a build; the workflow runs it.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "check_tidy: $*" >&2; exit 1; }

PATH="$PWD/.venv/bin:$PATH"
pinned=$(sed -n 's/.*"clang-tidy==\([0-9.]*\)".*/\1/p' pyproject.toml)
[ -n "$pinned" ] || fail "pyproject.toml pins no version of clang-tidy"
command -v clang-tidy >/dev/null || fail "no clang-tidy: pip install clang-tidy==$pinned"
clang-tidy --version | grep -qwF "$pinned" || fail "needs clang-tidy $pinned, found$(clang-tidy --version | grep version): pip install clang-tidy==$pinned"
[ -f build/release/compile_commands.json ] || fail "no build/release/compile_commands.json: run scripts/setup.sh"

# clang-tidy comes with the headers of its own compiler, but without omp.h. That of GCC will do, without an attribute that
# only GCC knows.
mkdir -p build/tidy/include
sed "s/, __malloc__ (omp_free)//; s/__malloc__ (omp_free), //" "$(g++ -print-file-name=include/omp.h)" >build/tidy/include/omp.h

files=("$@")
if [ ${#files[@]} -eq 0 ]; then
	# One file less: CGAL 5.5's boost/graph/iterator.h, which it includes, is refused by clang 19 and later.
	mapfile -t files < <(find filter_curvature_lines sample_data tests \( -name '*.h' -o -name '*.cpp' \) \
		! -name advancing_front.cpp | sort)
	[ ${#files[@]} -gt 100 ] || fail "found only ${#files[@]} files"
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/release --quiet --warnings-as-errors='*' \
	--extra-arg=-isystem --extra-arg="$PWD/build/tidy/include" 2>/dev/null ||
	fail "the files above break a rule of .clang-tidy"
