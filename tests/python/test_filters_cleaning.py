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


def check_denoised(meshes, cloud, report):
    """The report and the normals; returns the share of the RMS distance to the torus that is left."""
    positions, normals = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().vertex_normal_matrix()
    moved = np.linalg.norm(positions - cloud["positions"], axis=1)
    assert report["moved_rms"] == pytest.approx(rms(moved), rel=1e-6)
    assert report["moved_max"] == pytest.approx(moved.max(), rel=1e-6)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-9)
    truth = analytic_surfaces.project("torus", positions)["normals"]
    before = np.einsum("ij,ij->i", cloud["input_normals"], cloud["normals"])
    after = np.einsum("ij,ij->i", normals, truth)
    assert np.median(after) > np.median(before)
    return rms(distances(positions)) / rms(distances(cloud["positions"]))


def test_robust_denoising_moves_points_to_the_surface():
    cloud = generate("torus", 4000, noise=0.005, seed=1, scanned=True)
    meshes = layer_of(cloud)
    report = check_report(meshes.apply_filter(DENOISE))
    assert check_denoised(meshes, cloud, report) < 0.2
    noise = 0.005 * analytic_surfaces.surface("torus").diagonal
    assert report["noise"] == pytest.approx(noise, rel=0.12)
    assert 5.0 < report["radius"] < 40.0
    assert report["seconds_denoising"] <= report["seconds_total"]
    assert not {"iterations", "energy_final", "curvature_reused", "seconds_curvature"} & set(report)


def test_robust_denoising_takes_the_side_alone_from_the_normals(noisy_torus):
    tilted = noisy_torus["input_normals"] + 0.3 * np.roll(noisy_torus["input_normals"], 1, axis=0)
    good, bad = layer_of(noisy_torus), layer(noisy_torus["positions"], tilted)
    for meshes in (good, bad):
        meshes.apply_filter(DENOISE)
    np.testing.assert_allclose(bad.current_mesh().vertex_matrix(), good.current_mesh().vertex_matrix(), atol=1e-3)
    flipped = layer(noisy_torus["positions"], -noisy_torus["input_normals"])
    flipped.apply_filter(DENOISE)
    np.testing.assert_allclose(flipped.current_mesh().vertex_matrix(), good.current_mesh().vertex_matrix(), atol=1e-9)
    np.testing.assert_allclose(
        flipped.current_mesh().vertex_normal_matrix(), -good.current_mesh().vertex_normal_matrix(), atol=1e-9
    )


def test_noise_and_radius_are_taken_as_given(noisy_torus):
    def denoised(**parameters):
        meshes = layer_of(noisy_torus)
        report = meshes.apply_filter(DENOISE, **parameters)
        return report, rms(distances(meshes.current_mesh().vertex_matrix()))

    automatic, least = denoised()
    given, same = denoised(noise=automatic["noise"], radius=automatic["radius"])
    assert given["noise"] == pytest.approx(automatic["noise"], rel=1e-6)
    assert given["radius"] == pytest.approx(automatic["radius"], rel=1e-6)
    assert same == pytest.approx(least, rel=0.3)
    narrow, worse = denoised(radius=3.0)
    assert narrow["radius"] == 3.0 and worse > 1.2 * least


def test_published_denoising_moves_points_to_the_surface():
    cloud = generate("torus", 1600, noise=0.01, regular=True, seed=1, scanned=True)
    meshes = layer_of(cloud)
    report = check_report(meshes.apply_filter(DENOISE, method="Paper"), "iterations")
    # regular torus, one percent, square root energy: published for it are about 65 percent
    assert check_denoised(meshes, cloud, report) < 0.5
    assert report["energy_final"] < report["energy_initial"] and report["iterations"] <= 100


@pytest.mark.parametrize(
    "parameters", [{"energy": "Squared"}, {"optimizer": "Polak-Ribiere"}, {"neighbors": "Nearest"}, {"iterations": 5}]
)
def test_options_of_published_denoising(noisy_torus, parameters):
    paper = {"method": "Paper", "iterations": 10}
    default, other = layer_of(noisy_torus), layer_of(noisy_torus)
    default.apply_filter(DENOISE, **paper)
    report = other.apply_filter(DENOISE, **{**paper, **parameters})
    positions = other.current_mesh().vertex_matrix()
    assert np.any(positions != default.current_mesh().vertex_matrix())
    assert rms(distances(positions)) < rms(distances(noisy_torus["positions"]))
    assert report["iterations"] <= parameters.get("iterations", 10)


def test_published_denoising_uses_the_curvature_of_the_layer_only_while_it_is_fresh(noisy_torus):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    first = meshes.apply_filter(DENOISE, method="Paper", iterations=3)
    second = meshes.apply_filter(DENOISE, method="Paper", iterations=3)
    assert first["curvature_reused"] and not second["curvature_reused"]


@pytest.mark.parametrize("method", ["Robust", "Paper"])
def test_duplicates_stay_together_and_invalid_points_stay(torus, method):
    positions = np.vstack([torus["positions"], torus["positions"][:20]])
    normals = np.vstack([torus["normals"], torus["normals"][:20]])
    normals[30] = 0.0
    meshes = layer(positions, normals)
    meshes.apply_filter(DENOISE, method=method, iterations=3)
    moved = meshes.current_mesh().vertex_matrix()
    np.testing.assert_array_equal(moved[:20], moved[-20:])
    np.testing.assert_array_equal(moved[30], positions[30])
    assert np.any(moved[:20] != positions[:20])


def selection_of(cloud):
    meshes = layer_of(cloud)
    meshes.apply_filter(OUTLIERS)
    return meshes.current_mesh().vertex_selection_array()


@pytest.mark.parametrize(
    "kind, noise, recall", [({"outliers": 0.05}, 0.0025, 0.96), ({"near_outliers": 0.05}, 0.005, 0.88)]
)
def test_outliers_clearly_off_the_surface_are_found_and_little_else(kind, noise, recall):
    cloud = generate("torus", 4000, noise=noise, seed=1, scanned=True, **kind)
    selected, outside = selection_of(cloud), cloud["label"] != 0
    far = distances(cloud["positions"]) > 3.0 * noise * analytic_surfaces.surface("torus").diagonal
    assert np.mean(selected[outside & far]) >= recall
    assert np.count_nonzero(selected & ~outside) <= 0.02 * np.count_nonzero(selected & outside & far)


@pytest.mark.parametrize("surface", ["torus", "cube", "helicoid"])
def test_clean_clouds_have_no_outliers(surface):
    assert np.mean(selection_of(generate(surface, 4000, seed=1, scanned=True))) <= 0.001


def denoised(cloud):
    meshes = layer_of(cloud)
    meshes.apply_filter(DENOISE)
    return meshes.current_mesh().vertex_matrix()


@pytest.mark.parametrize("surface, points, bound", [("torus", 1600, 0.26), ("helicoid", 1730, 0.25)])
def test_denoising_neither_shrinks_nor_leaves_much_noise(surface, points, bound):
    cloud = generate(surface, points, noise=0.005, seed=1, scanned=True)
    before = rms(np.linalg.norm(cloud["positions"] - cloud["foot_points"], axis=1))
    moved = denoised(cloud)
    truth = analytic_surfaces.project(surface, moved)
    offsets = moved - truth["foot_points"]
    assert rms(np.linalg.norm(offsets, axis=1)) <= bound * before
    assert abs(np.einsum("ij,ij->i", offsets, truth["normals"]).mean()) <= 0.03 * before


def test_denoising_keeps_the_rim():
    cloud = generate("helicoid", 1730, noise=0.005, seed=1, scanned=True)
    spacing = np.sqrt(9.3 / len(cloud["positions"]))  # its area is 9.29
    rim = cloud["rim_distance"] < spacing
    moved = analytic_surfaces.project("helicoid", denoised(cloud))["rim_distance"]
    assert np.quantile((moved - cloud["rim_distance"])[rim], 0.95) <= 0.1 * spacing


def test_denoising_keeps_edges():
    cloud = generate("cube", 6000, noise=0.005, seed=1, scanned=True)
    edge = cloud["feature_distance"] < 0.05
    before = np.linalg.norm(cloud["positions"] - cloud["foot_points"], axis=1)
    moved = denoised(cloud)
    after = np.linalg.norm(moved - analytic_surfaces.project("cube", moved)["foot_points"], axis=1)
    assert rms(after[edge]) <= 0.35 * rms(before[edge])
    assert rms(after[~edge]) <= 0.12 * rms(before[~edge])


def test_denoising_tells_layers_that_are_there_twice():
    random = np.random.default_rng(3)
    flat = random.random((3000, 2))
    heights = np.where(np.arange(3000) < 1500, 0.0, 0.02) + random.normal(0.0, 0.001, 3000)
    normals = np.tile([0.0, 0.0, 1.0], (3000, 1))
    meshes = layer(np.column_stack([flat, heights]), normals)
    report = meshes.apply_filter(DENOISE)
    assert report["doubled_share"] > 0.9 and report["warnings"] == 1
    assert np.std(meshes.current_mesh().vertex_matrix()[:, 2]) < 0.002
    once = layer(np.column_stack([flat, random.normal(0.0, 0.01, 3000)]), normals).apply_filter(DENOISE)
    assert once["doubled_share"] == 0.0 and once["warnings"] == 0


def test_hair_is_told_or_rejected():
    random = np.random.default_rng(5)
    outward = random.normal(size=(3000, 3))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    hair = random.uniform(-0.3, 0.3, (1500, 3)) + [1.5, 0.0, 0.0]
    turned = random.normal(size=hair.shape)
    normals = np.vstack([outward, turned / np.linalg.norm(turned, axis=1, keepdims=True)])
    meshes = layer(np.vstack([outward, hair]), normals)
    told = meshes.apply_filter(OUTLIERS)
    assert told["warnings"] == 1 and 0.25 < told["unstructured_share"] < 0.4
    assert meshes.current_mesh().vertex_selection_array().mean() < 0.1
    rejected = meshes.apply_filter(OUTLIERS, reject_unstructured=True)
    selected = meshes.current_mesh().vertex_selection_array()
    assert selected[3000:].mean() > 0.95 and selected[:3000].mean() < 0.002
    assert rejected["warnings"] == 0 and abs(rejected["unstructured_share"] - 1 / 3) < 0.02
