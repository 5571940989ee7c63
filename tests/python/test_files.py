# Clouds from files, and meshes and lines into files: digits, polygons, edges, and files that are whole or not there.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pymeshlab
import pytest

from helpers import PIPELINE, TRACE, analytic_surfaces, generate, layer_of

files = pytest.importorskip("pymeshlab_curvature_lines.files", reason="tests a plugin file, not the package")
FAR = np.array([403000.0, 5804900.0, 120.0])  # as of a map grid, in metres


def test_georeferenced_meshes_and_lines_keep_their_digits(tmp_path):
    cloud = generate("torus", 1500, seed=1)
    far = {**cloud, "positions": cloud["positions"] + FAR}
    meshes = layer_of(far)
    meshes.apply_filter(PIPELINE, denoise=False, reject_outliers=False)
    mesh = meshes.current_mesh()
    files.save_mesh(mesh, tmp_path / "quads.obj")
    loaded = files.load_cloud(tmp_path / "quads.obj")
    again = loaded.current_mesh()
    assert np.array_equal(again.vertex_matrix(), mesh.vertex_matrix())
    distance = (
        analytic_surfaces.project("torus", again.vertex_matrix() - FAR)["foot_points"] + FAR - again.vertex_matrix()
    )
    assert np.sqrt(np.mean(distance**2)) < 0.005

    read = pymeshlab.MeshSet()
    read.load_new_mesh(str(tmp_path / "quads.obj"))
    loops = [tuple(face) for face in read.current_mesh().polygonal_face_list()]
    assert sorted(map(sorted, loops)) == sorted(sorted(map(int, face)) for face in mesh.polygonal_face_list())

    meshes.set_current_mesh(0)
    meshes.apply_filter(TRACE, target_vertices=200)
    lines = meshes.current_mesh()
    files.save_mesh(lines, tmp_path / "lines.obj")
    read.load_new_mesh(str(tmp_path / "lines.obj"))
    assert np.array_equal(read.current_mesh().vertex_matrix(), lines.vertex_matrix())
    assert set(map(frozenset, read.current_mesh().edge_matrix().tolist())) == set(
        map(frozenset, lines.edge_matrix().tolist())
    )
    groups = [line for line in (tmp_path / "lines.obj").read_text().splitlines() if line.startswith("g ")]
    ids = lines.vertex_custom_scalar_attribute_array("line_id")
    assert len(groups) == len(set(groups)) == len(np.unique(ids))
    assert {group.rsplit("_", 1)[1] for group in groups} == {"1", "2"}


def test_colors_are_no_normals_and_stay(tmp_path):
    cloud = generate("torus", 800, seed=2)
    colors = np.random.default_rng(3).integers(0, 256, (800, 3))
    np.savetxt(tmp_path / "c.xyz", np.column_stack([cloud["positions"], colors]), fmt="%.6f %.6f %.6f %d %d %d")
    heard = []
    loaded = files.load_cloud(tmp_path / "c.xyz", heard.append)
    mesh = loaded.current_mesh()
    assert not mesh.vertex_normal_matrix().any()
    assert np.allclose(255.0 * mesh.vertex_color_matrix()[:, :3], colors, atol=0.6)
    assert heard == ["800 points; coordinates in columns 1 to 3, colours in columns 4 to 6"]


def test_point_sets_of_a_renderer_are_no_tables(tmp_path):
    cloud = generate("torus", 500, seed=4)
    rows = np.column_stack([cloud["positions"], cloud["normals"]]).astype("<f4")
    head = "[Expe/PointSet/Binary/0.1]\nproperty position 12\nproperty normal 12\nnofpoints 500\ndata\n"
    (tmp_path / "c.pts").write_bytes(head.encode() + rows.tobytes())
    loaded = files.load_cloud(tmp_path / "c.pts")
    assert np.allclose(loaded.current_mesh().vertex_matrix(), cloud["positions"], atol=1e-6)
    assert np.allclose(loaded.current_mesh().vertex_normal_matrix(), cloud["normals"], atol=1e-6)


def test_files_without_points_and_of_other_kinds_are_refused(tmp_path):
    (tmp_path / "empty.obj").write_text("# nothing\n")
    with pytest.raises((ValueError, pymeshlab.PyMeshLabException), match="points|Unable"):
        files.load_cloud(tmp_path / "empty.obj")
    with pytest.raises(ValueError, match="OBJ"):
        files.save_mesh(pymeshlab.Mesh(np.eye(3)), tmp_path / "a.stl")


def test_a_file_is_whole_or_not_there(tmp_path):
    target = tmp_path / "result.txt"
    target.write_text("before")
    with pytest.raises(RuntimeError, match="full"), files.whole_file(target) as partial:
        partial.write_text("half")
        raise RuntimeError("disk full")
    assert target.read_text() == "before" and list(tmp_path.iterdir()) == [target]
    with files.whole_file(target) as partial:
        partial.write_text("after")
    assert target.read_text() == "after" and list(tmp_path.iterdir()) == [target]
