# Outlier selection and denoising through the real plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pymeshlab
import pytest

from helpers import CURVATURE, DENOISE, OUTLIERS, analytic_surfaces, check_report, generate, layer, layer_of, rms


@pytest.fixture(scope="module")
def dirty():
    return generate("torus", 1200, noise=0.0025, outliers=0.05, seed=3, scanned=True)


def distances(positions):
    return np.linalg.norm(positions - analytic_surfaces.project("torus", positions)["foot_points"], axis=1)


def test_outliers_are_selected(dirty):
    meshes = layer_of(dirty)
    report = check_report(meshes.apply_filter(OUTLIERS), "outliers", "isolated", "rounds", "deleted")
    selected = meshes.current_mesh().vertex_selection_array()
    assert report["outliers"] == selected.sum() and report["deleted"] == 0
    outside = dirty["label"] != 0
    far = distances(dirty["positions"]) > 0.1  # some "outliers" fall on the surface by chance
    assert np.mean(selected[outside & far]) > 0.85
    assert np.mean(selected[~outside]) < 0.02
    noise = 0.0025 * analytic_surfaces.surface("torus").diagonal
    assert 0.3 * noise < report["noise"] < 3.0 * noise


def test_selection_replaces_the_former_one(dirty):
    fresh, used = layer_of(dirty), layer_of(dirty)
    used.set_selection_all()
    for meshes in (fresh, used):
        meshes.apply_filter(OUTLIERS)
    np.testing.assert_array_equal(
        fresh.current_mesh().vertex_selection_array(), used.current_mesh().vertex_selection_array()
    )


def test_outliers_are_deleted_on_request(dirty):
    meshes, deleting = layer_of(dirty), layer_of(dirty)
    outliers = meshes.apply_filter(OUTLIERS)["outliers"]
    report = deleting.apply_filter(OUTLIERS, delete_selected=True)
    assert report["deleted"] == outliers > 0
    left = ~meshes.current_mesh().vertex_selection_array()
    np.testing.assert_array_equal(deleting.current_mesh().vertex_matrix(), dirty["positions"][left])
    np.testing.assert_array_equal(deleting.current_mesh().vertex_normal_matrix(), dirty["input_normals"][left])


def test_deleting_takes_the_faces_along(dirty):
    count = len(dirty["positions"])
    faces = np.arange(count - count % 3).reshape(-1, 3)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(
        pymeshlab.Mesh(vertex_matrix=dirty["positions"], face_matrix=faces, v_normals_matrix=dirty["input_normals"])
    )
    report = meshes.apply_filter(OUTLIERS, delete_selected=True)
    mesh = meshes.current_mesh()
    assert report["deleted"] > 0 and mesh.vertex_number() == count - report["deleted"]
    assert 0 < mesh.face_number() < len(faces) and mesh.face_matrix().max() < mesh.vertex_number()


def test_sensitivity_and_vote_threshold(dirty):
    def outliers(**parameters):
        return layer_of(dirty).apply_filter(OUTLIERS, rounds=1, **parameters)["outliers"]

    assert outliers(sensitivity=1.5) > outliers(sensitivity=3.5) >= outliers(sensitivity=20.0)
    assert outliers(mode="Paper", vote_threshold=0.2) > outliers(mode="Paper", vote_threshold=0.8)


def test_nowhere_points_are_outliers_but_points_without_normal_are_not(torus):
    positions, normals = torus["positions"].copy(), torus["normals"].copy()
    positions[3] = np.nan
    normals[5] = 0.0
    meshes = layer(positions, normals)
    report = meshes.apply_filter(OUTLIERS)
    selected = meshes.current_mesh().vertex_selection_array()
    assert report["invalid"] == 2 and selected[3] and not selected[5]


def test_denoising_moves_points_to_the_surface():
    cloud = generate("torus", 1600, noise=0.01, regular=True, seed=1, scanned=True)
    meshes = layer_of(cloud)
    report = check_report(meshes.apply_filter(DENOISE), "iterations")
    positions = meshes.current_mesh().vertex_matrix()
    # dossier, section 18: regular torus, one percent, square root energy: at least 60 percent
    assert rms(distances(positions)) < 0.5 * rms(distances(cloud["positions"]))
    moved = np.linalg.norm(positions - cloud["positions"], axis=1)
    assert report["moved_rms"] == pytest.approx(rms(moved), rel=1e-6)
    assert report["moved_max"] == pytest.approx(moved.max(), rel=1e-6)
    assert report["energy_final"] < report["energy_initial"] and report["iterations"] <= 100
    normals = meshes.current_mesh().vertex_normal_matrix()
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-9)
    truth = analytic_surfaces.project("torus", positions)["normals"]
    before = np.einsum("ij,ij->i", cloud["input_normals"], cloud["normals"])
    after = np.einsum("ij,ij->i", normals, truth)
    assert np.median(after) > np.median(before)


@pytest.mark.parametrize(
    "parameters", [{"energy": "Squared"}, {"optimizer": "Polak-Ribiere"}, {"neighbors": "Nearest"}, {"iterations": 5}]
)
def test_denoising_options(noisy_torus, parameters):
    default, other = layer_of(noisy_torus), layer_of(noisy_torus)
    default.apply_filter(DENOISE, iterations=10)
    report = other.apply_filter(DENOISE, **{"iterations": 10, **parameters})
    positions = other.current_mesh().vertex_matrix()
    assert np.any(positions != default.current_mesh().vertex_matrix())
    assert rms(distances(positions)) < rms(distances(noisy_torus["positions"]))
    assert report["iterations"] <= parameters.get("iterations", 10)


def test_denoising_uses_the_curvature_of_the_layer_only_while_it_is_fresh(noisy_torus):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    first = meshes.apply_filter(DENOISE, iterations=3)
    second = meshes.apply_filter(DENOISE, iterations=3)
    assert first["curvature_reused"] and not second["curvature_reused"]


def test_duplicates_stay_together_and_invalid_points_stay(torus):
    positions = np.vstack([torus["positions"], torus["positions"][:20]])
    normals = np.vstack([torus["normals"], torus["normals"][:20]])
    normals[30] = 0.0
    meshes = layer(positions, normals)
    meshes.apply_filter(DENOISE, iterations=3)
    moved = meshes.current_mesh().vertex_matrix()
    np.testing.assert_array_equal(moved[:20], moved[-20:])
    np.testing.assert_array_equal(moved[30], positions[30])
    assert np.any(moved[:20] != positions[:20])
