# The command curvature-lines: files and folders, what it writes, its exit status and what it says.
# SPDX-License-Identifier: GPL-3.0-or-later
import re
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest

from helpers import CHECKOUT

pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")
CLOUD = CHECKOUT / "sample_data/cube_600.ply"


def run(folder, *arguments):
    command = [sys.executable, "-m", "pymeshlab_curvature_lines.cli", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def vertex_header(file):
    return file.read_bytes().split(b"end_header")[0].decode()


def test_one_cloud_and_every_file(tmp_path):
    done = run(
        tmp_path, CLOUD, "-o", "q.obj", "--lines", "l.obj", "--curvature", "c.ply", "--report", "r.html", "--quiet"
    )
    assert done.returncode == 0, done.stderr
    assert re.search(r"^f \S+ \S+ \S+ \S+$", (tmp_path / "q.obj").read_text(), re.MULTILINE)
    assert re.search(r"^l \d+ \d+$", (tmp_path / "l.obj").read_text(), re.MULTILINE)
    assert {"curv_k1", "curv_k2", "moved"} <= set(vertex_header(tmp_path / "c.ply").split())
    page = (tmp_path / "r.html").read_text()
    assert page.count("<svg") == 2 and "<rect" in page
    assert not re.search(r'(src|href)="(?!data:)', page)  # opens offline
    for word in ("reject outliers", "Position Field", "pymeshlab-curvature-lines", "Euler characteristic 2"):
        assert word in page, word


def test_a_folder_goes_on_after_a_broken_file(tmp_path):
    clouds = tmp_path / "clouds"
    clouds.mkdir()
    (clouds / "a_broken.ply").write_text("nothing")
    (clouds / "notes.txt.bak").write_text("not a cloud")
    (clouds / "cube.ply").write_bytes(CLOUD.read_bytes())
    done = run(tmp_path, "clouds", "-o", "out", "--report", "out", "--quiet")
    assert done.returncode == 1 and "a_broken.ply" in done.stderr and "cube" not in done.stderr
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["cube.html", "cube_quads.obj"]


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["no_such.ply", "-o", "q.obj"], "no such file"),
        ([CLOUD, "-o", "q.ply"], "OBJ"),
        ([CLOUD, "-o", "q.obj", "--lines", "l.ply"], "OBJ"),
        ([CLOUD, "-o", "q.obj", "--curvature", "c.obj"], "PLY"),
        ([CLOUD, "-o", "none/q.obj"], "no such folder"),
        ([CLOUD, "-o", "q.obj", "--target-vertices", "-1"], "negative"),
        ([CLOUD, "-o", "q.obj", "--target-vertices", "99999999999"], "at most"),
        ([CLOUD, "-o", "q.obj", "--lines", "q.obj"], "another result"),
        ([CLOUD, "-o", "q.obj", "--lines", "./q.obj"], "another result"),
        ([CLOUD, "-o", "q.obj", "--curvature", "c.ply", "--report", "c.ply"], "another result"),
        ([CLOUD.parent, "-o", "q.obj"], "folder"),
        ([CLOUD, CLOUD, "-o", "out"], "overwrite"),
        ([".", "-o", "out"], "no point clouds"),
        ([CLOUD], "required"),
    ],
)
def test_wrong_usage_is_refused_before_any_work(tmp_path, arguments, words):
    done = run(tmp_path, *arguments)
    assert done.returncode == 2 and words in done.stderr, done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("output", ["scan.ply", "./scan.ply", "linked.ply"])
def test_the_input_is_never_overwritten(tmp_path, output):
    scan = tmp_path / "scan.ply"
    scan.write_bytes(CLOUD.read_bytes())
    (tmp_path / "linked.ply").hardlink_to(scan)
    done = run(tmp_path, "scan.ply", "-o", output, "--triangulate")
    assert done.returncode == 2 and "would overwrite the input" in done.stderr
    done = run(tmp_path, "scan.ply", "-o", "q.obj", "--curvature", output)
    assert done.returncode == 2 and "would overwrite the input" in done.stderr
    assert scan.read_bytes() == CLOUD.read_bytes() and not (tmp_path / "q.obj").exists()


def test_results_never_become_the_next_runs_input(tmp_path):
    clouds = tmp_path / "clouds"
    clouds.mkdir()
    (clouds / "cube.ply").write_bytes(CLOUD.read_bytes())
    for arguments in (["-o", "clouds"], ["-o", "out", "--curvature", "clouds/../clouds"]):
        done = run(tmp_path, "clouds", *arguments)
        assert done.returncode == 2 and "next run's input" in done.stderr, done.stderr
    assert [file.name for file in clouds.iterdir()] == ["cube.ply"]


def test_text_tables_are_read_and_what_their_columns_are_is_told(tmp_path):
    random = np.random.default_rng(2)
    points = random.normal(size=(1200, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    table = np.column_stack([points, random.integers(0, 256, (1200, 3))])
    np.savetxt(tmp_path / "scan.csv", table, fmt="%.6f,%.6f,%.6f,%d,%d,%d")
    done = run(tmp_path, "scan.csv", "-o", "q.obj", "--no-denoise", "--no-outliers")
    assert done.returncode == 0, done.stderr
    assert "scan.csv: 1200 points; coordinates in columns 1 to 3, colours in columns 4 to 6" in done.stdout
    vertices = [line.split()[1:] for line in (tmp_path / "q.obj").read_text().splitlines() if line.startswith("v ")]
    assert np.allclose(np.linalg.norm(np.array(vertices, dtype=float), axis=1), 1.0, atol=0.02)
    (tmp_path / "empty.csv").write_text("")
    done = run(tmp_path, "empty.csv", "-o", "e.obj")
    assert done.returncode == 1 and re.search(r"empty\.csv: .*holds no points", done.stderr)


def test_help_has_examples():
    done = run(None, "--help")
    assert done.returncode == 0 and "examples:" in done.stdout and "exit status" in done.stdout


def test_how_far_points_moved():
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(CHECKOUT / "sample_data/torus_1600_noise1.ply"))
    report = meshes.generate_surface_reconstruction_curvature_aligned(keep_intermediate_layers=True)
    cleaned = next(mesh for mesh in meshes if mesh.label() == "cleaned cloud")
    moved = cleaned.vertex_custom_scalar_attribute_array("moved")
    assert np.sqrt(np.mean(moved**2)) == pytest.approx(report["moved_rms"], rel=1e-6)


def test_what_the_mesh_does_not_show_is_told():
    from pymeshlab_curvature_lines.pipeline import Reconstruction

    counts = {"uncovered_share": 0.02, "folded_faces": 3, "dropped_components": 2}
    told = Reconstruction(pymeshlab.MeshSet(), 0, None, 1, counts, {}).losses()
    assert [re.match(r"[\d.]+", sentence)[0] for sentence in told] == ["2", "3", "2"]
    assert all("target vertices" in sentence for sentence in told)
    nothing = dict.fromkeys(counts, 0)
    assert Reconstruction(pymeshlab.MeshSet(), 0, None, 1, nothing, {}).losses() == []
