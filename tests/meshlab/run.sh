#!/usr/bin/env bash
# The plugin in MeshLab's own window, under an X server without a screen: every filter by its dialog, the filter scripts,
# errors, a large cloud, loading by hand. Screenshots, saved files and figures are left in build/meshlab/.
# usage: run.sh [SCENARIO …] (every_filter, scripts, errors, large, plugin_info; all by default). Status 77: skipped.
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
readonly root=$PWD/build/meshlab-root out=$PWD/build/meshlab stage=/opt/tour
[ $# -gt 0 ] || set -- every_filter scripts errors large plugin_info

tests/meshlab/make_root.sh "$root"
[ -f build/release/meshlab/libfilter_curvature_lines.so ] && .venv/bin/python -c 'import pymeshlab_curvature_lines' || scripts/setup.sh

rm -rf "$out" "$root$stage"
mkdir -p "$out" "$root$stage/clouds" "$root$stage/out"
cp tests/meshlab/*.py build/release/meshlab/libfilter_curvature_lines.so "$root$stage"
cp -r python_bindings/filter_scripts "$root$stage/scripts"
cp sample_data/torus_1600_noise1.ply "$root$stage/clouds/cloud.ply"
cp sample_data/cube_600.ply "$root$stage/clouds/cube.ply"
.venv/bin/python tests/meshlab/clouds.py "$root$stage/clouds"

failed=0
for scenario in "$@"; do
	echo "--- $scenario"
	scripts/in_debian_root.sh "$root" dbus-run-session -- python3 -B "$stage/tour.py" "$scenario" 2>"$out/$scenario.err" || {
		failed=1
		tail -3 "$out/$scenario.err"
	}
	cp -r "$root$stage/out/." "$out"
done
.venv/bin/python tests/meshlab/check_saved.py "$out" || failed=1
exit $failed
