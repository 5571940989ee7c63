# The Python interface of the sample generator, and the clouds committed in sample_data/.
# SPDX-License-Identifier: GPL-3.0-or-later
import shlex
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from helpers import CHECKOUT, analytic_surfaces

SAMPLES = CHECKOUT / "sample_data"
COMMANDS = [
    shlex.split(line)[2:]
    for line in (SAMPLES / "README.md").read_text(encoding="utf-8").splitlines()
    if line.startswith(".venv/bin/python sample_data/analytic_surfaces.py")
]


def read_ply(path):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.vertex_normal_matrix()


@pytest.mark.parametrize("name", analytic_surfaces.surface_names())
def test_cloud_agrees_with_projection_of_its_points(name):
    cloud = analytic_surfaces.generate(name, 300, noise=0.01, outliers=0.1, near_outliers=0.1, seed=2)
    truth = analytic_surfaces.project(name, cloud["positions"])
    for key, array in truth.items():
        np.testing.assert_array_equal(cloud[key], array)
    frames = np.stack([cloud["d1"], cloud["d2"], cloud["normals"]], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.tile(np.eye(3), (len(frames), 1, 1)), atol=1e-12)
    assert np.all(cloud["k1"] >= cloud["k2"])
    assert np.all(np.isinf(truth["rim_distance"])) == analytic_surfaces.surface(name).closed


def test_rows_are_points():
    sphere = analytic_surfaces.generate("sphere", 50, seed=1)
    np.testing.assert_allclose(np.linalg.norm(sphere["positions"], axis=1), 1.0)
    np.testing.assert_allclose(sphere["normals"], sphere["positions"], atol=1e-12)
    np.testing.assert_allclose([sphere["k1"], sphere["k2"]], 1.0)
    lifted = analytic_surfaces.project("sphere", 1.7 * sphere["positions"])
    np.testing.assert_allclose(lifted["foot_points"], sphere["positions"], atol=1e-12)


def test_same_seed_same_cloud_and_noise_level():
    clouds = [analytic_surfaces.generate("torus", 4000, noise=0.01, seed=s) for s in (1, 1, 2)]
    np.testing.assert_array_equal(clouds[0]["positions"], clouds[1]["positions"])
    assert not np.array_equal(clouds[0]["positions"], clouds[2]["positions"])
    offset = clouds[0]["positions"] - clouds[0]["foot_points"]
    rms = np.sqrt(np.mean(np.sum(offset**2, axis=1)))
    assert rms == pytest.approx(0.01 * analytic_surfaces.surface("torus").diagonal, rel=0.05)


def test_labels_count_the_outliers():
    cloud = analytic_surfaces.generate("helicoid", 1800, noise=0.005, outliers=0.1, near_outliers=0.05, seed=1)
    assert np.bincount(cloud["label"]).tolist() == [1800, 200, 95]


def test_plane_fit_normals_are_unit_outward_and_better_with_more_neighbours():
    cloud = analytic_surfaces.generate("torus", 2000, noise=0.01, seed=1)
    median = {}
    for neighbors in (12, 25, 50):
        normals = analytic_surfaces.plane_fit_normals(cloud["positions"], cloud["normals"], neighbors)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
        cosine = np.einsum("ij,ij->i", normals, cloud["normals"])
        assert np.all(cosine >= 0.0)
        median[neighbors] = np.degrees(np.median(np.arccos(np.minimum(1.0, cosine))))
    assert median[50] < median[25] < median[12]
    # What fits to 25 neighbours have at this noise and density, whatever the implementation.
    assert median[25] == pytest.approx(6.0, abs=0.6)


def test_wrong_input_is_refused_by_name():
    with pytest.raises(ValueError, match="klein_bottle.*torus"):
        analytic_surfaces.generate("klein_bottle", 10)
    with pytest.raises(ValueError, match="klein_bottle"):
        analytic_surfaces.project("klein_bottle", np.zeros((1, 3)))
    with pytest.raises(ValueError, match="N x 3"):
        analytic_surfaces.project("torus", np.zeros((3, 4)))
    with pytest.raises(ValueError, match="positive"):
        analytic_surfaces.generate("torus", 0)


def test_every_committed_cloud_is_in_the_readme():
    written = {Path(command[command.index("-o") + 1]).name for command in COMMANDS}
    assert written == {path.name for path in SAMPLES.glob("*.ply")}


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: Path(c[c.index("-o") + 1]).stem)
def test_committed_cloud_is_what_its_command_writes(command, tmp_path):
    committed = CHECKOUT / command[command.index("-o") + 1]
    fresh = tmp_path / committed.name
    analytic_surfaces.main(command[: command.index("-o")] + ["-o", str(fresh)])
    # Mathematical functions differ in the last digits between systems.
    for ours, theirs in zip(read_ply(fresh), read_ply(committed), strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-9)
    assert committed.stat().st_size < 200_000
