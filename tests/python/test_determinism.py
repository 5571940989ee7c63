# The same result in every process, for any number of threads and, where that is promised, for any order of the points:
# of every filter the plugin brings, with all values of its enums.
# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

import filter_table
from helpers import ATTRIBUTES, FILTERS, SMOOTH, TRACE

# Prints the name of every case with a hash of all layers, pictures and reports.
EVERY_CASE = """
import hashlib, tempfile
from pathlib import Path
import filter_table, helpers
for name, turn in filter_table.cases():
    with tempfile.TemporaryDirectory() as folder:
        given = filter_table.values(name, turn, Path(folder))
        meshes = filter_table.document(name)
        report = meshes.apply_filter(name, **given)
        report = {key: value for key, value in report.items() if not key.startswith("seconds")}
        pictures = [Path(given[key]).read_bytes() for key in filter_table.files_of(name, Path(folder))]
        state = repr([helpers.snapshot(meshes), sorted(report.items()), pictures])
        print("case", name, turn, hashlib.sha256(state.encode()).hexdigest())
"""
# One filter after another on the same layers, which hand on what they found.
CHAIN = """
import hashlib, helpers
meshes = helpers.layer_of(helpers.generate("torus", 1600, noise=0.003, outliers=0.02, seed=1, scanned=True))
chain = [
    (helpers.CURVATURE, {}),
    (helpers.OUTLIERS, {"delete_selected": True}),
    (helpers.DENOISE, {"method": "Paper", "iterations": 10}),
    (helpers.DENOISE, {}),
    (helpers.SMOOTH, {}),
    (helpers.TRACE, {"target_vertices": 100}),
    (helpers.MESH, {}),
]
for step, (name, parameters) in enumerate(chain):
    meshes.apply_filter(name, **parameters)
    print("case", "chain", step, hashlib.sha256(repr(helpers.snapshot(meshes)).encode()).hexdigest())
"""


def run(threads):
    result = subprocess.run(
        [sys.executable, "-c", EVERY_CASE + CHAIN],
        cwd=Path(__file__).parent,
        env={**os.environ, "OMP_NUM_THREADS": str(threads)},
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    lines = [line.split() for line in result.stdout.splitlines() if line.startswith("case ")]
    return {(name, turn): hash_ for _, name, turn, hash_ in lines}


def test_every_filter_is_the_same_on_one_thread_and_on_two():
    with ThreadPoolExecutor(2) as both:
        one, two = both.map(run, [1, 2])
    assert len(one) == len(filter_table.cases()) + 7
    assert {name for name, _ in one} == {*FILTERS, "chain"}
    assert len(set(one.values())) > 0.9 * len(one)  # else it is not the filter's work that is hashed
    assert {case for case in one if one[case] != two[case]} == set()


def permuted(cloud):
    order = np.random.default_rng(4).permutation(len(cloud["positions"]))
    return {**cloud, **{key: cloud[key][order] for key in ("positions", "normals", "input_normals")}}


def in_place_order(mesh):
    """Vertices by their place: what a layer of points is, in whatever order."""
    place = np.round(mesh.vertex_matrix(), 9) + 0.0
    return np.lexsort(place.T)


def columns(mesh, vertices):
    """All numbers a vertex carries, in this order of the vertices."""
    read = [mesh.vertex_matrix(), mesh.vertex_normal_matrix(), mesh.vertex_scalar_array()[:, None]]
    read += [mesh.vertex_selection_array()[:, None], mesh.vertex_color_matrix()]
    for name in ATTRIBUTES:
        try:
            read.append(mesh.vertex_custom_scalar_attribute_array(name)[:, None])
        except pymeshlab.PyMeshLabException:
            pass
    return np.hstack(read)[vertices]


def loops(mesh):
    """Faces, each from its lowest vertex on."""
    return {tuple(np.roll(face, -int(np.argmin(face)))) for face in mesh.face_matrix()}


def smooths_directions(name, given):
    """It pairs every point with some of its many neighbours, which it picks by their place in the file."""
    traced = name == TRACE and given.get("method", "Traced Lines") == "Traced Lines"
    return name == SMOOTH or (traced and given.get("smooth_directions", True))


@pytest.mark.parametrize("name, turn", filter_table.cases(), ids=filter_table.case_id)
def test_the_order_of_the_points_does_not_matter(name, turn, tmp_path):
    given = filter_table.values(name, turn, tmp_path)
    results, reports, pictures = [], [], []
    for change in (lambda cloud: cloud, permuted):
        meshes = filter_table.document(name, change)
        reports.append(meshes.apply_filter(name, **given))
        results.append(list(meshes))
        pictures.append([Path(given[key]).read_bytes() for key in filter_table.files_of(name, tmp_path)])
    counts = [{k: v for k, v in report.items() if type(v) is int and not k.startswith("seconds")} for report in reports]
    if smooths_directions(name, given):
        assert counts[1] == pytest.approx(counts[0], rel=0.02)
        return
    assert counts[0] == counts[1]
    assert pictures[0] == pictures[1]
    for layer, (mesh, other) in enumerate(zip(*results, strict=True)):
        points = mesh.edge_number() == mesh.face_number() == 0
        orders = [in_place_order(each) if points else slice(None) for each in (mesh, other)]
        np.testing.assert_allclose(
            columns(mesh, orders[0]), columns(other, orders[1]), rtol=1e-9, atol=1e-9, err_msg=f"layer {layer}"
        )
        assert np.array_equal(mesh.edge_matrix(), other.edge_matrix())
        assert loops(mesh) == loops(other)
