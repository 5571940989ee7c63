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
