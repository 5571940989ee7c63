# Estimate and Orient Normals through the real plugin: sides, doubt, open surfaces, layers with holes in their data.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from helpers import (
    CURVATURE,
    DENOISE,
    NEED_NORMALS,
    NORMALS,
    OUTLIERS,
    PIPELINE,
    PROJECT,
    RAY_TRACE,
    SMOOTH,
    TRACE,
    generate,
    layer,
)

QUICK = {TRACE: {"epsilon": 0.01}, RAY_TRACE: {"image_file": "picture.png", "width": 60, "height": 40}}


def estimate(positions, given=None, **options):
    meshes = layer(positions, given)
    report = getattr(meshes, NORMALS)(**options)
    mesh = meshes.current_mesh()
    return mesh.vertex_normal_matrix(), mesh.vertex_custom_scalar_attribute_array("normal_doubt"), report


@pytest.mark.parametrize("name", ["torus", "ellipsoid"])
def test_closed_surfaces_look_outward(name):
    cloud = generate(name, 2000, noise=0.003, seed=1)
    normals, doubt, report = estimate(cloud["positions"])
    assert np.mean(np.sum(normals * cloud["normals"], axis=1) <= 0) < 0.002
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    assert doubt.min() >= 0 and doubt.max() <= 1
    assert report["doubtful_share"] == pytest.approx(np.mean(doubt > 0.4))
    assert report["doubtful_share"] < 0.05 and report["open_share"] == 0 and report["warnings"] == 0


def test_the_side_of_former_normals_has_no_say_and_flip_turns_all():
    cloud = generate("sphere", 1000, seed=2)
    outward = estimate(cloud["positions"], -cloud["normals"])[0]
    assert np.all(np.sum(outward * cloud["normals"], axis=1) > 0)
    assert np.array_equal(estimate(cloud["positions"], flip=True)[0], -outward)


def test_open_surfaces_look_where_they_are_told_to():
    random = np.random.default_rng(3)
    xy = random.uniform(-1, 1, (1500, 2))
    points = np.column_stack([xy, 0.1 * np.sin(3 * xy[:, 0])])
    up, _, report = estimate(points, orientation="Up")
    assert up[:, 2].min() > 0 and report["open_share"] == 1
    down = estimate(points, orientation="Viewpoint", viewpoint=[0.0, 0.0, -4.0])[0]
    assert down[:, 2].max() < 0


def test_noise_without_a_surface_is_told():
    report = estimate(np.random.default_rng(4).random((2000, 3)))[2]
    assert report["doubtful_share"] > 0.05 and report["warnings"] == 1


def test_points_that_are_nowhere_are_left_alone():
    cloud = generate("sphere", 600, seed=5)
    points = cloud["positions"].copy()
    points[7] = np.nan
    normals, doubt, report = estimate(points)
    assert report["invalid"] == 1 and doubt[7] == 0
    rest = np.arange(600) != 7
    assert np.all(np.sum(normals[rest] * cloud["normals"][rest], axis=1) > 0)


def test_the_pipeline_says_what_is_in_doubt():
    cloud = generate("torus", 1500, seed=6)
    meshes = layer(cloud["positions"])
    report = getattr(meshes, PIPELINE)()
    assert report["normals_estimated"] and report["doubtful_share"] < 0.05


def told(positions, normals):
    report = getattr(layer(positions, normals), DENOISE)()
    return report["normals_disagreeing"], report["normals_torn"], report["warnings"]


def test_given_normals_that_cannot_be_right_are_told():
    cloud = generate("torus", 2000, noise=0.002, seed=7)
    points, normals = cloud["positions"], cloud["normals"]
    assert told(points, normals) == (0, 0, 0)
    assert told(points, np.tile([0.0, 0.0, 1.0], (2000, 1)))[2] >= 1
    random = np.random.default_rng(8).standard_normal((2000, 3))
    disagreeing, _, warnings = told(points, random / np.linalg.norm(random, axis=1, keepdims=True))
    assert disagreeing > 0.3 and warnings >= 1
    sides = np.where(np.random.default_rng(9).random(2000) < 0.1, -1.0, 1.0)[:, None]
    disagreeing, torn, warnings = told(points, sides * normals)
    assert disagreeing == 0 and torn > 0.1 and warnings >= 1
    assert told(points, 5 * normals)[2] == 1


def outcome(meshes, name):
    """What a filter leaves behind, but for the normals of the cloud."""
    report = meshes.apply_filter(name, **QUICK.get(name, {}))
    left = [meshes.mesh(0).vertex_matrix(), meshes.mesh(0).vertex_selection_array()]
    for index in range(1, meshes.mesh_number()):
        left += [meshes.mesh(index).vertex_matrix(), meshes.mesh(index).edge_matrix()]
    if name == CURVATURE:
        left.append(meshes.mesh(0).vertex_custom_scalar_attribute_array("curv_k1"))
    return report, left


@pytest.mark.parametrize("name", NEED_NORMALS)
def test_filters_estimate_normals_that_are_missing_and_leave_the_layer_without(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    positions = generate("torus", 1500, noise=0.001, seed=10)["positions"]
    bare, oriented = layer(positions), layer(positions)
    oriented.apply_filter(NORMALS)
    report, left = outcome(bare, name)
    expected_report, expected = outcome(oriented, name)
    assert report["normals_estimated"] and not expected_report["normals_estimated"]
    assert report["doubtful_share"] < 0.05 and report["open_share"] == 0
    for mine, theirs in zip(left, expected, strict=True):
        assert mine.shape == theirs.shape and np.allclose(mine, theirs, rtol=1e-6, atol=1e-9)
    if name not in (DENOISE, PROJECT):  # which write normals anyhow
        assert not bare.mesh(0).vertex_normal_matrix().any()


def test_curvature_is_reused_on_a_layer_without_normals():
    meshes = layer(generate("torus", 1500, seed=11)["positions"])
    meshes.apply_filter(CURVATURE)
    assert meshes.apply_filter(SMOOTH)["curvature_reused"]


def test_normals_estimated_on_the_way_are_written_when_asked_for():
    cloud = generate("torus", 1500, seed=12)
    meshes = layer(cloud["positions"])
    meshes.apply_filter(CURVATURE, correct_normals=True)
    assert np.all(np.sum(meshes.current_mesh().vertex_normal_matrix() * cloud["normals"], axis=1) > 0.9)


def test_the_sign_of_curvature_is_a_guess_on_open_surfaces_and_that_is_told():
    xy = np.random.default_rng(13).uniform(-1, 1, (1500, 2))
    points = np.column_stack([xy, 0.1 * np.sin(3 * xy[:, 0])])
    report = layer(points).apply_filter(CURVATURE)
    assert report["open_share"] == 1 and report["warnings"] == 1
    assert layer(points).apply_filter(OUTLIERS)["warnings"] == 0  # sides make no difference there


def test_thin_walls_without_normals_keep_their_points():
    """Two sheets two spacings apart: no point is an outlier, and denoising leaves each where it is."""
    random = np.random.default_rng(14)
    xy = random.uniform(0, 1, (3000, 2))
    apart = 2.0 / np.sqrt(1500)
    height = np.where(np.arange(3000) % 2 == 0, 0.0, apart)
    points = np.column_stack([xy, height + 0.02 * apart * random.normal(size=3000)])
    assert layer(points).apply_filter(OUTLIERS)["outliers"] < 0.005 * 3000
    meshes = layer(points)
    meshes.apply_filter(DENOISE)
    left = np.abs(meshes.current_mesh().vertex_matrix()[:, 2] - height)
    assert np.sqrt(np.mean(left**2)) < 0.02 * apart
