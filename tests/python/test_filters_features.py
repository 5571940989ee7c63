# Sharp feature lines through the real plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from helpers import DENOISE, FEATURES, MESH, attribute, check_report, generate, layer_of, rms, snapshot

COUNTS = ["points", "invalid", "vertices", "edges", "curves", "closed_curves", "concave_curves", "corners"]


def extract(cloud, **parameters):
    meshes = layer_of(cloud)
    return meshes, check_report(meshes.apply_filter(FEATURES, **parameters), *COUNTS)


def distance_to_cube_edges(positions):
    """Of points near the surface of the cube: two coordinates of an edge's points are 1/2."""
    off = np.sort(np.abs(np.abs(positions) - 0.5), axis=1)
    return np.hypot(off[:, 0], off[:, 1])


@pytest.fixture(scope="module")
def cube():
    return generate("cube", 3000, seed=1)


def test_cube(cube):
    meshes, report = extract(cube)
    assert (report["curves"], report["corners"], report["closed_curves"], report["concave_curves"]) == (12, 8, 0, 0)
    assert report["length"] == pytest.approx(12.0, rel=0.002)
    mesh = meshes.current_mesh()
    assert mesh.label() == "sharp features" and meshes.mesh_number() == 2
    assert mesh.vertex_number() == report["vertices"] and mesh.edge_number() == report["edges"]
    assert distance_to_cube_edges(mesh.vertex_matrix()).max() < 0.002
    np.testing.assert_allclose(mesh.vertex_scalar_array(), 90.0, atol=5.0)
    # in the middle of an edge, the normal halves the angle of the faces
    middle = np.sort(np.abs(mesh.vertex_matrix()), axis=1)[:, 0] < 0.3
    normals = mesh.vertex_normal_matrix()
    expected = np.where(np.abs(mesh.vertex_matrix()) > 0.4, np.sign(mesh.vertex_matrix()), 0.0) / np.sqrt(2.0)
    np.testing.assert_allclose(normals[middle], expected[middle], atol=0.02)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)


def test_edges_join_the_vertices_of_a_line_in_turn(cube):
    meshes, report = extract(cube, spacing=0.05)
    mesh, line = meshes.current_mesh(), attribute(meshes, "line_id")
    edges = mesh.edge_matrix()
    assert sorted(set(line)) == list(range(12))
    assert np.all(line[edges[:, 0]] == line[edges[:, 1]])
    assert len(edges) == mesh.vertex_number() - 12  # all open
    lengths = np.linalg.norm(np.diff(mesh.vertex_matrix()[edges], axis=1), axis=2)
    np.testing.assert_allclose(lengths, 0.05, atol=0.01)


def test_noisy_cube():
    meshes, report = extract(generate("cube", 6000, noise=0.0025, seed=1, scanned=True))
    assert (report["curves"], report["corners"]) == (12, 8)
    assert rms(distance_to_cube_edges(meshes.current_mesh().vertex_matrix())) / np.sqrt(3.0) < 0.0025


def test_concave_edge_is_negative():
    meshes, report = extract(generate("l_block", 3000, seed=1))
    assert (report["curves"], report["corners"], report["concave_curves"]) == (18, 12, 1)
    positions, angle = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().vertex_scalar_array()
    beside_corners = np.abs(positions[:, 2]) < 0.24  # where convex lines end in the same places
    concave = np.linalg.norm(positions[:, :2], axis=1) < 0.01
    assert np.all((angle < 0.0)[beside_corners] == concave[beside_corners]) and concave.sum() > 5


def test_circles_are_closed():
    meshes, report = extract(generate("capped_cylinder", 3000, seed=1))
    assert (report["curves"], report["closed_curves"], report["corners"]) == (2, 2, 0)
    assert report["edges"] == report["vertices"]
    assert report["length"] == pytest.approx(2.0 * np.pi, rel=0.01)


@pytest.mark.parametrize("surface, noise", [("torus", 0.0), ("torus", 0.02), ("helicoid", 0.01), ("plane", 0.0)])
def test_smooth_surfaces_and_rims_add_no_layer(surface, noise):
    cloud = generate(surface, 1500, noise=noise, seed=1, scanned=noise > 0.0)
    meshes, before = layer_of(cloud), snapshot(layer_of(cloud))
    report = check_report(meshes.apply_filter(FEATURES), *COUNTS)
    assert report["curves"] == report["vertices"] == report["edges"] == report["length"] == 0
    assert snapshot(meshes) == before


def test_denoised_clouds_need_no_more_of_it(cube):
    meshes = layer_of(generate("cube", 6000, noise=0.0025, seed=1, scanned=True))
    meshes.apply_filter(DENOISE)
    report = meshes.apply_filter(FEATURES, denoise=False)
    assert (report["curves"], report["corners"]) == (12, 8)
    assert "seconds_denoising" not in report


def test_smallest_angle(cube):
    meshes, report = extract(cube, min_angle=120.0)
    assert report["curves"] == 0 and meshes.mesh_number() == 1


def test_cloud_stays_and_lines_are_no_lines_of_curvature(cube):
    meshes, _ = extract(cube)
    np.testing.assert_array_equal(meshes.mesh(0).vertex_matrix(), cube["positions"])
    with pytest.raises(Exception, match="no lines of curvature"):
        meshes.apply_filter(MESH, point_cloud=0)
