# Projection onto a cloud's own surface, and its pictures, through the real plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pymeshlab
import pytest

from helpers import PROJECT, RAY_TRACE, analytic_surfaces, check_report, generate, layer, layer_of, rms, snapshot

SMALL = {"width": 60, "height": 40}


def distance(positions):
    return rms(np.linalg.norm(positions - analytic_surfaces.project("torus", positions)["foot_points"], axis=1))


def spacing(cloud):
    return np.sqrt(4.0 * np.pi**2 * 0.4 / len(cloud["positions"]))


def two_layers(control, proxy):
    meshes = layer_of(control)
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=proxy))
    return meshes


@pytest.fixture(scope="module")
def dense():
    return generate("torus", 5000, seed=3)


def test_proxy_moves_onto_the_surface_of_the_control_points(dense):
    proxy = dense["positions"][:500] + np.random.default_rng(1).normal(scale=0.3 * spacing(dense), size=(500, 3))
    proxy[0] = [9.0, 9.0, 9.0]
    meshes = two_layers(dense, proxy)
    report = check_report(meshes.apply_filter(PROJECT, control_mesh=0, proxy_mesh=1), "projected", "not_projected")
    assert report["points"] == 500 and report["not_projected"] == 1
    moved = meshes.mesh(1).vertex_matrix()
    assert np.array_equal(moved[0], proxy[0])
    assert distance(moved[1:]) < 0.03 * spacing(dense)
    normals = meshes.mesh(1).vertex_normal_matrix()[1:]
    assert np.all(np.einsum("ij,ij->i", normals, analytic_surfaces.project("torus", moved[1:])["normals"]) > 0.99)
    assert np.array_equal(meshes.mesh(0).vertex_matrix(), dense["positions"])

    meshes.apply_filter(PROJECT, control_mesh=0, proxy_mesh=1)  # what lies on it stays
    assert rms(np.linalg.norm(meshes.mesh(1).vertex_matrix() - moved, axis=1)) < 1e-3 * spacing(dense)


@pytest.mark.parametrize("function", ["Hermite", "Cutoff", "Rational"])
def test_surface_of_a_noisy_cloud_is_smoother(function):
    cloud = generate("torus", 20000, noise=0.005, seed=4, scanned=True)
    some = cloud["positions"][:2000]
    meshes = two_layers(cloud, some)
    meshes.apply_filter(PROJECT, control_mesh=0, proxy_mesh=1, diffusion_function=function)
    assert distance(meshes.mesh(1).vertex_matrix()) < 0.35 * distance(some)


def test_resampling_makes_a_new_denser_layer(dense):
    meshes = layer_of(dense)
    before = snapshot(meshes)[1:]
    report = meshes.apply_filter(PROJECT, resample=4)
    assert meshes.mesh_number() == 2 and meshes.current_mesh_id() == 1
    denser = meshes.current_mesh()
    assert denser.vertex_number() == report["projected"] > 0.99 * 4 * 5000
    assert distance(denser.vertex_matrix()) < 0.05 * spacing(dense)
    meshes.set_current_mesh(0)
    assert snapshot(meshes)[1 : len(before) // 2] == before[: len(before) // 2 - 1]


def test_projection_names_what_is_wrong(dense, torus):
    meshes = two_layers(dense, torus["positions"] + 50.0)
    before = snapshot(meshes)
    for parameters, words in [
        ({"control_mesh": 0, "proxy_mesh": 1}, "near the surface"),
        ({"control_mesh": 7, "proxy_mesh": 1}, "no such layer"),
        ({"control_mesh": 1, "proxy_mesh": 0}, "near the surface"),
        ({"bandwidth": 0.1, "control_mesh": 0, "proxy_mesh": 0}, "bandwidth"),
        ({"resample": 0, "control_mesh": 0, "proxy_mesh": 0}, "resample"),
    ]:
        with pytest.raises(pymeshlab.PyMeshLabException, match=words):
            meshes.apply_filter(PROJECT, **parameters)
        assert snapshot(meshes) == before


def picture(meshes, path, **parameters):
    report = check_report(
        meshes.apply_filter(RAY_TRACE, image_file=str(path), **{**SMALL, **parameters}), "pixels", "hits"
    )
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert (int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")) == (SMALL["width"], SMALL["height"])
    return report, data


def test_picture_of_a_torus(torus, tmp_path):
    meshes = layer_of(torus)
    before = snapshot(meshes)
    report, plain = picture(meshes, tmp_path / "plain.png")
    assert report["pixels"] == 2400 and 0.2 < report["hits"] / 2400 < 0.7
    assert snapshot(meshes) == before
    again, same = picture(meshes, tmp_path / "again.png")
    assert same == plain and again["hits"] == report["hits"]
    squares, _ = picture(meshes, tmp_path / "mls.png", surface="Moving Least Squares")
    assert abs(squares["hits"] - report["hits"]) <= 24
    _, curved = picture(meshes, tmp_path / "curvature.png", color_by="Curvature")
    _, blue = picture(meshes, tmp_path / "blue.png", background=pymeshlab.Color(0, 0, 255, 255))
    assert len({plain, curved, blue}) == 3


def test_camera_given(torus, tmp_path):
    meshes = layer_of(torus)
    axis, _ = picture(
        meshes,
        tmp_path / "axis.png",
        camera="Given",
        camera_position=np.array([0.0, 8.0, 0.0]),
        camera_up=np.array([0.0, 0.0, 1.0]),
    )
    away, _ = picture(
        meshes, tmp_path / "away.png", camera="Given", camera_position=np.array([0.0, 8.0, 0.0]),
        camera_target=np.array([0.0, 9.0, 0.0]), camera_up=np.array([0.0, 0.0, 1.0]),
    )  # fmt: skip
    assert axis["hits"] > 100 and away["hits"] == 0


def test_lines_are_drawn(torus, tmp_path):
    meshes = layer_of(torus)
    _, bare = picture(meshes, tmp_path / "bare.png")
    ends = torus["positions"][:40]
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=ends, edge_matrix=np.arange(40).reshape(20, 2)))
    meshes.set_current_mesh(0)
    report, drawn = picture(meshes, tmp_path / "drawn.png", lines=1)
    assert report["segments"] == 20 and drawn != bare


def test_pictures_name_what_is_wrong(torus, tmp_path):
    meshes = layer_of(torus)
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=torus["positions"]))
    meshes.set_current_mesh(0)
    for parameters, words in [
        ({}, "image_file"),
        ({"image_file": str(tmp_path / "a.jpg")}, "png"),
        ({"image_file": str(tmp_path / "none" / "a.png")}, "folder"),
        ({"image_file": str(tmp_path / "a.png"), "width": 0}, "width"),
        ({"image_file": str(tmp_path / "a.png"), "lines": 1}, "no edges"),
        ({"image_file": str(tmp_path / "a.png"), "lines": 5}, "no such layer"),
        (
            {"image_file": str(tmp_path / "a.png"), "camera": "Given", "camera_up": np.array([0.0, 0.0, 1.0])},
            "camera_up",
        ),
    ]:
        with pytest.raises(pymeshlab.PyMeshLabException, match=words):
            meshes.apply_filter(RAY_TRACE, **parameters)
    assert list(tmp_path.iterdir()) == []


def test_picture_of_a_layer_without_normals(torus, tmp_path):
    with_normals, _ = picture(layer_of(torus), tmp_path / "with.png")
    report, _ = picture(layer(torus["positions"]), tmp_path / "without.png")
    assert report["normals_estimated"] and abs(report["hits"] - with_normals["hits"]) <= 48
