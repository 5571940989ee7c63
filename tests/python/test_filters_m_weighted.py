# M-weighted curvature through the real plugin: the figure of the 2006 paper, conventions, chaining.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from helpers import (
    CURVATURE,
    M_WEIGHTED,
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
)

COUNTS = ["ok", "boundary", "too_few_neighbors", "umbilic", "isolated", "invalid", "duplicates"]


def k1_error(cloud, **parameters):
    meshes = layer_of(cloud)
    meshes.apply_filter(M_WEIGHTED, **parameters)
    return rms(attribute(meshes, "curv_k1") - cloud["k1"])


def test_clean_torus(torus):
    meshes = layer_of(torus)
    report = check_report(meshes.apply_filter(M_WEIGHTED), *COUNTS)
    assert report["points"] == len(torus["positions"]) == sum(report[name] for name in COUNTS[:6])
    assert rms(attribute(meshes, "curv_k1") - torus["k1"]) < 0.05 * np.max(torus["k1"])
    mesh = meshes.current_mesh()
    d1, d2 = mesh.vertex_curvature_principal_dir1_matrix(), mesh.vertex_curvature_principal_dir2_matrix()
    clear = torus["k1"] - torus["k2"] > 1.0
    assert np.median(axis_angle(d1, torus["d1"])[clear]) < 0.03
    frames = np.stack([d1, d2, torus["normals"]], axis=1)
    assert np.max(np.abs(frames @ frames.transpose(0, 2, 1) - np.eye(3))) < 1e-9
    assert np.allclose(mesh.vertex_scalar_array(), 0.5 * (attribute(meshes, "curv_k1") + attribute(meshes, "curv_k2")))


def test_m_weights_withstand_noise_that_other_weights_do_not():
    cloud = generate("torus", 2000, noise=0.0025, seed=1)
    m = k1_error(cloud)
    assert m < 0.3
    assert m < 0.5 * k1_error(cloud, weighting="Unweighted")
    assert m < 0.2 * k1_error(cloud, weighting="Gaussian")


def test_sphere_is_exact_and_umbilic():
    sphere = generate("sphere", 1000, seed=1)
    meshes = layer(100.0 * sphere["positions"], 7.0 * sphere["normals"])
    report = meshes.apply_filter(M_WEIGHTED)
    assert np.allclose(attribute(meshes, "curv_k1"), 0.01) and np.allclose(attribute(meshes, "curv_k2"), 0.01)
    assert report["umbilic"] == 1000 and np.all(attribute(meshes, "curv_status") == UMBILIC)


def test_flipped_normals_turn_curvature_over(torus):
    values = []
    for sign in (1, -1):
        meshes = layer(torus["positions"], sign * torus["normals"])
        meshes.apply_filter(M_WEIGHTED)
        values.append(attributes(meshes))
    assert np.allclose(values[0]["curv_k1"], -values[1]["curv_k2"])
    assert np.allclose(values[0]["curv_error"], values[1]["curv_error"])


@pytest.mark.parametrize(
    "scalar, attribute_name", [("K1", "curv_k1"), ("K2", "curv_k2"), ("Confidence", "curv_confidence")]
)
def test_scalar_becomes_quality(torus, scalar, attribute_name):
    meshes = layer_of(torus)
    meshes.apply_filter(M_WEIGHTED, scalar=scalar)
    assert np.allclose(meshes.current_mesh().vertex_scalar_array(), attribute(meshes, attribute_name))
    assert meshes.current_mesh().has_vertex_color()


def test_filters_that_go_on_use_the_robust_curvature():
    cloud = generate("torus", 1000, seed=77)  # which nothing else has estimated before
    meshes, robust = layer_of(cloud), layer_of(cloud)
    meshes.apply_filter(M_WEIGHTED)
    report = meshes.apply_filter(SMOOTH)
    robust.apply_filter(CURVATURE)
    robust.apply_filter(SMOOTH)
    assert not report["curvature_reused"]
    assert np.all(attribute(robust, "curv_status") == OK)
    assert np.array_equal(
        meshes.current_mesh().vertex_curvature_principal_dir1_matrix(),
        robust.current_mesh().vertex_curvature_principal_dir1_matrix(),
    )
