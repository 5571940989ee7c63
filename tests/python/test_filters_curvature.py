# Robust curvature through the real plugin: values, conventions, attributes, colours, chaining.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from helpers import (
    ATTRIBUTES,
    CURVATURE,
    INVALID,
    OK,
    SMOOTH,
    UMBILIC,
    attribute,
    attributes,
    axis_angle,
    check_report,
    generate,
    layer,
    layer_of,
    rms,
    snapshot,
)

MODES = ["Adaptive", "Paper"]
COUNTS = ["ok", "boundary", "too_few_neighbors", "umbilic", "isolated", "invalid", "duplicates", "iterations"]


def directions(meshes):
    mesh = meshes.current_mesh()
    return mesh.vertex_curvature_principal_dir1_matrix(), mesh.vertex_curvature_principal_dir2_matrix()


def test_torus_curvature_and_directions(torus):
    meshes = layer_of(torus)
    report = check_report(meshes.apply_filter(CURVATURE), *COUNTS)
    assert report["points"] == len(torus["positions"]) == sum(report[name] for name in COUNTS[:6])
    largest = np.max(np.abs(torus["k1"]))
    assert rms(attribute(meshes, "curv_k1") - torus["k1"]) < 0.05 * largest
    assert rms(attribute(meshes, "curv_k2") - torus["k2"]) < 0.05 * largest
    d1, d2 = directions(meshes)
    clear = torus["k1"] - torus["k2"] > 1.0
    assert np.median(axis_angle(d1, torus["d1"])[clear]) < 0.02
    assert np.median(axis_angle(d2, torus["d2"])[clear]) < 0.02


# Paper: what the published method's prototype reached on a torus of 2000 points
@pytest.mark.parametrize("mode, k1, k2", [("Adaptive", 0.2, 0.17), ("Paper", 0.3, 0.25)])
def test_noise_is_resisted(noisy_torus, mode, k1, k2):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE, scale_mode=mode)
    assert rms(attribute(meshes, "curv_k1") - noisy_torus["k1"]) < k1
    assert rms(attribute(meshes, "curv_k2") - noisy_torus["k2"]) < k2


def frames_of(meshes, normals):
    frames = np.stack([*directions(meshes), normals], axis=1)
    return frames @ frames.transpose(0, 2, 1) - np.eye(3)


@pytest.mark.parametrize("mode", MODES)
def test_conventions_hold_at_every_vertex(noisy_torus, mode):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE, scale_mode=mode)
    assert np.max(np.abs(frames_of(meshes, noisy_torus["input_normals"])[:, :2, :2])) < 1e-9
    values = attributes(meshes)
    assert all(np.all(np.isfinite(array)) for array in values.values())
    assert np.all(values["curv_k1"] >= values["curv_k2"])
    assert np.all(values["curv_error"] >= 0.0) and np.all(values["curv_confidence"] >= 0.0)
    assert np.all(values["curv_scale"] > 0.0)
    assert np.all((values["curv_feature"] >= 0.0) & (values["curv_feature"] <= 1.0))
    assert set(np.unique(values["curv_status"])) <= set(range(6))


def test_directions_are_tangent_to_the_normals_with_scale_paper_and_to_exact_ones(noisy_torus, torus):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE, scale_mode="Paper")
    assert np.max(np.abs(frames_of(meshes, noisy_torus["input_normals"]))) < 1e-9
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE)
    assert np.max(np.abs(frames_of(meshes, torus["normals"]))) < 1e-9


def test_directions_are_tangent_to_the_surface_where_the_normals_are_not_right(noisy_torus):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    surface = np.cross(*directions(meshes))
    given, truth = noisy_torus["input_normals"], noisy_torus["normals"]
    assert np.all(np.einsum("ij,ij->i", surface, given) > 0.5)
    assert rms(axis_angle(surface, truth)) < 0.7 * rms(axis_angle(given, truth))
    tangent = axis_angle(surface, given) < 1e-6
    apart = axis_angle(surface, given) > np.radians(0.99)
    assert np.all(tangent | apart) and np.any(tangent) and np.any(apart)


def test_flipped_normals_turn_curvature_over(torus):
    values = []
    for sign in (1, -1):
        meshes = layer(torus["positions"], sign * torus["normals"])
        meshes.apply_filter(CURVATURE)
        values.append(attributes(meshes))
    # not exactly: the six sectors of a neighbourhood start at another angle when the normal turns round
    largest = np.max(np.abs(torus["k1"]))
    assert rms(values[1]["curv_k1"] + values[0]["curv_k2"]) < 0.02 * largest
    assert rms(values[1]["curv_k2"] + values[0]["curv_k1"]) < 0.02 * largest


def test_sphere_is_convex_and_umbilic():
    sphere = generate("sphere", 1000, seed=1)
    meshes = layer(2.0 * sphere["positions"], sphere["normals"])
    report = meshes.apply_filter(CURVATURE)
    assert np.median(attribute(meshes, "curv_k1")) == pytest.approx(0.5, rel=0.03)
    assert np.median(attribute(meshes, "curv_k2")) == pytest.approx(0.5, rel=0.03)
    assert report["umbilic"] == np.sum(attribute(meshes, "curv_status") == UMBILIC) > 900


@pytest.mark.parametrize(
    "scalar, expected",
    [
        ("Mean", lambda v: (v["curv_k1"] + v["curv_k2"]) / 2),
        ("Gaussian", lambda v: v["curv_k1"] * v["curv_k2"]),
        ("K1", lambda v: v["curv_k1"]),
        ("K2", lambda v: v["curv_k2"]),
        ("Curvedness", lambda v: np.hypot(v["curv_k1"], v["curv_k2"]) / np.sqrt(2)),
        ("Shape Index", lambda v: 2 / np.pi * np.arctan2(v["curv_k1"] + v["curv_k2"], v["curv_k1"] - v["curv_k2"])),
        ("Confidence", lambda v: v["curv_confidence"]),
    ],
)
def test_quality_is_the_chosen_scalar(torus, scalar, expected):
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE, scalar=scalar)
    mesh = meshes.current_mesh()
    np.testing.assert_allclose(mesh.vertex_scalar_array(), expected(attributes(meshes)), rtol=1e-6, atol=1e-9)
    assert len(np.unique(mesh.vertex_color_matrix(), axis=0)) > 100


def test_colours_tell_convex_from_saddle(torus):
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE)
    red, green, blue, alpha = meshes.current_mesh().vertex_color_matrix().T
    convex = torus["k2"] > 0.3
    saddle = torus["k2"] < -0.8
    assert np.mean((red > np.maximum(green, blue))[convex]) > 0.9
    assert np.mean((green > np.maximum(red, blue))[saddle]) > 0.9
    assert np.all(alpha == 1.0)


def test_colours_stay_unless_asked_for(torus):
    meshes = layer_of(torus)
    before = meshes.current_mesh().vertex_color_matrix().tobytes()
    meshes.apply_filter(CURVATURE, colorize=False)
    assert meshes.current_mesh().vertex_color_matrix().tobytes() == before


@pytest.mark.parametrize("mode", MODES)
def test_corrected_normals_are_better_and_directions_tangent_to_them(noisy_torus, mode):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE, scale_mode=mode, correct_normals=True)
    normals = meshes.current_mesh().vertex_normal_matrix()
    errors = [
        np.arccos(np.clip(np.einsum("ij,ij->i", n, noisy_torus["normals"]), -1, 1))
        for n in (noisy_torus["input_normals"], normals)
    ]
    assert rms(errors[1]) < 0.9 * rms(errors[0])
    d1, d2 = directions(meshes)
    assert np.max(np.abs(np.einsum("ij,ij->i", d1, normals))) < 1e-9
    assert np.max(np.abs(np.einsum("ij,ij->i", d2, normals))) < 1e-9


def test_corrected_normals_point_outward_where_the_given_ones_do_not(noisy_torus):
    random = np.random.default_rng(3)
    wrong = random.random(len(noisy_torus["positions"])) < 0.15
    normals = noisy_torus["input_normals"].copy()
    normals[wrong] = random.normal(size=(wrong.sum(), 3))
    meshes = layer(noisy_torus["positions"], normals)
    meshes.apply_filter(CURVATURE, correct_normals=True)
    cosines = np.einsum("ij,ij->i", meshes.current_mesh().vertex_normal_matrix(), noisy_torus["normals"])
    assert cosines.min() > 0.0


def test_the_adaptive_estimate_does_not_depend_on_the_normals_beyond_their_side(noisy_torus):
    plain, corrected = layer_of(noisy_torus), layer_of(noisy_torus)
    plain.apply_filter(CURVATURE)
    corrected.apply_filter(CURVATURE, correct_normals=True)
    for name in ATTRIBUTES:
        np.testing.assert_array_equal(attribute(plain, name), attribute(corrected, name))
    # and what the layer now carries is used
    assert corrected.apply_filter(SMOOTH)["curvature_reused"]


def test_error_and_scale_are_in_model_units(noisy_torus):
    values = []
    for factor in (1.0, 8.0):
        meshes = layer(factor * noisy_torus["positions"], noisy_torus["input_normals"])
        meshes.apply_filter(CURVATURE)
        values.append(attributes(meshes))
    for name, power in {"curv_k1": -1, "curv_k2": -1, "curv_error": -1, "curv_scale": 1, "curv_feature": 0}.items():
        np.testing.assert_allclose(values[1][name], 8.0**power * values[0][name], rtol=1e-6, atol=1e-9)
    error = (values[0]["curv_k1"] - values[0]["curv_k2"]) - (noisy_torus["k1"] - noisy_torus["k2"])
    assert 0.2 < rms(error) / rms(values[0]["curv_error"]) < 3.0
    # regions of the published scale are three spacings: far too small for this noise
    assert 0.3 < np.median(values[0]["curv_scale"]) < 1.5


def test_region_scale_is_in_local_spacings(torus):
    radius = {}
    # Smaller regions would grow to hold enough points for a fit.
    for scale in (3.0, 4.5):
        meshes = layer_of(torus)
        report = meshes.apply_filter(CURVATURE, scale_mode="Paper", region_scale=scale)
        radius[scale] = np.median(attribute(meshes, "curv_scale"))
        assert radius[scale] == pytest.approx(scale * report["median_spacing"], rel=0.2)
    assert radius[4.5] == pytest.approx(1.5 * radius[3.0], rel=0.05)


def test_points_without_estimate_are_zero_and_counted(torus):
    normals = torus["normals"].copy()
    normals[:7] = 0.0
    meshes = layer(torus["positions"], normals)
    report = meshes.apply_filter(CURVATURE)
    values = attributes(meshes)
    assert report["invalid"] == 7 and np.all(values["curv_status"][:7] == INVALID)
    assert np.all(values["curv_k1"][:7] == 0.0) and np.all(values["curv_confidence"][:7] == 0.0)
    assert np.sum(values["curv_status"] == OK) == report["ok"]
    d1, d2 = directions(meshes)
    np.testing.assert_allclose(np.linalg.norm(np.stack([d1, d2]), axis=2), 1.0, atol=1e-12)


def test_duplicates_share_one_estimate(torus):
    meshes = layer(
        np.vstack([torus["positions"], torus["positions"][:50]]), np.vstack([torus["normals"], torus["normals"][:50]])
    )
    report = meshes.apply_filter(CURVATURE)
    assert report["duplicates"] == 50
    single = layer_of(torus)
    single.apply_filter(CURVATURE)
    for name in ATTRIBUTES:
        values, alone = attribute(meshes, name), attribute(single, name)
        np.testing.assert_array_equal(values[-50:], values[:50])
        np.testing.assert_allclose(values[:-50], alone, rtol=1e-6, atol=1e-9)


def test_changing_only_the_scalar_keeps_the_estimate(torus):
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE)
    first = attributes(meshes)
    meshes.apply_filter(CURVATURE, scalar="Gaussian")
    second = attributes(meshes)
    for name in ATTRIBUTES:
        np.testing.assert_array_equal(first[name], second[name])


def test_every_parameter_has_an_effect_or_is_checked(noisy_torus):
    def k1(**parameters):
        meshes = layer_of(noisy_torus)
        meshes.apply_filter(CURVATURE, **parameters)
        return attribute(meshes, "curv_k1")

    default = k1()
    np.testing.assert_array_equal(default, k1(scale_mode="Adaptive"))
    paper = k1(scale_mode="Paper")
    np.testing.assert_array_equal(
        paper, k1(scale_mode="Paper", region_scale=3.0, max_iterations=30, feature_gate=True, boundary_threshold=2.5)
    )
    assert np.any(paper != default)
    for parameters in ({"max_iterations": 1}, {"feature_gate": False}, {"region_scale": 2.0}):
        assert np.any(k1(scale_mode="Paper", **parameters) != paper), parameters
        np.testing.assert_array_equal(k1(**parameters), default)
    counts = {}
    for threshold in (1.0, 2.5):
        meshes = layer_of(noisy_torus)
        counts[threshold] = meshes.apply_filter(CURVATURE, boundary_threshold=threshold)["boundary"]
    assert counts[1.0] > counts[2.5]
    umbilic = {}
    for ratio in (0.3, 1.0):
        meshes = layer_of(noisy_torus)
        umbilic[ratio] = meshes.apply_filter(CURVATURE, umbilic_ratio=ratio)["umbilic"]
    assert umbilic[0.3] > umbilic[1.0]


def test_the_same_call_on_the_same_cloud_writes_the_same(noisy_torus):
    first, second = layer_of(noisy_torus), layer_of(noisy_torus)
    first.apply_filter(CURVATURE)
    second.apply_filter(CURVATURE)
    assert snapshot(first) == snapshot(second)


OTHER = {"region_scale": 4.5, "max_iterations": 1, "feature_gate": False, "boundary_threshold": 1.2}


@pytest.mark.parametrize("parameter", OTHER)
def test_no_estimate_with_other_parameters_is_served(noisy_torus, parameter):
    default, other, again = (layer_of(noisy_torus) for _ in range(3))
    default.apply_filter(CURVATURE, scale_mode="Paper")
    other.apply_filter(CURVATURE, scale_mode="Paper", **{parameter: OTHER[parameter]})
    again.apply_filter(CURVATURE, scale_mode="Paper")
    values = [attributes(meshes) for meshes in (default, other, again)]
    assert any(np.any(values[0][name] != values[1][name]) for name in ATTRIBUTES)
    assert all(np.all(values[0][name] == values[2][name]) for name in ATTRIBUTES)
