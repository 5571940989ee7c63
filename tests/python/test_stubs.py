# What editors and type checkers know of the filters is what the filters declare.
# SPDX-License-Identifier: GPL-3.0-or-later
import inspect
import subprocess
import sys

import pymeshlab
import pytest

from helpers import CHECKOUT

package = pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")
WRITER = CHECKOUT / "python_bindings/type_stubs/write_stubs.py"
HEAD = "from pymeshlab_curvature_lines import MeshSet\n\nms = MeshSet()\nms.load_new_mesh('scan.ply')\n"
RIGHT = """
report = ms.generate_surface_reconstruction_curvature_aligned(target_vertices=300, method="Traced Lines", denoise=False)
faces: float = report["faces"]
ms.save_ray_traced_point_set_image(image_file="a.png", camera="Given", camera_position=[0, 0, 2], lines=1)
ms.meshing_invert_face_orientation()
"""
WRONG = {
    "ms.generate_curvature_lines(epsilom=1e-4)": "epsilom",
    "ms.generate_curvature_lines(method='Traced')": "Literal",
    "ms.compute_curvature_robust_per_vertex(colorize='yes')": "bool",
    "ms.apply_coord_point_cloud_robust_denoising(0.1)": "positional",
    "ms.generate_curvature_lines() + 1": "operand",
}


def mypy(source, tmp_path):
    file = tmp_path / "user.py"
    file.write_text(source)
    # PyMeshLab itself has no types: what is its own stays unchecked.
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--ignore-missing-imports",
        "--cache-dir",
        str(tmp_path),
        str(file),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_stub_is_up_to_date():
    sys.path.insert(0, str(WRITER.parent))
    import write_stubs

    assert write_stubs.STUB.read_text() == write_stubs.stub(), f"run {WRITER.relative_to(CHECKOUT)}"


def test_the_stub_comes_with_the_package_and_its_class_is_the_hosts():
    folder = package.plugin_path().parent
    assert (folder / "__init__.pyi").exists() and (folder / "py.typed").exists()
    assert package.MeshSet is pymeshlab.MeshSet
    assert all(callable(inspect.getattr_static(package.MeshSet, name)) for name in package.filters())


def test_right_calls_pass_a_type_checker(tmp_path):
    done = mypy(HEAD + RIGHT, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_wrong_calls_do_not(tmp_path):
    done = mypy(HEAD + "\n".join(WRONG), tmp_path)
    errors = [line for line in done.stdout.splitlines() if ": error:" in line]
    first = HEAD.count("\n") + 1
    for number, (call, word) in enumerate(WRONG.items(), start=first):
        assert any(f"user.py:{number}:" in line and word in line for line in errors), (
            f"{call}: {done.stdout}{done.stderr}"
        )
