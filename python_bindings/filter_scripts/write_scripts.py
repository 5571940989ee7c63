# Writes the filter scripts of this folder: complete, as MeshLab's window needs them, with the defaults of the plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run it after a change of parameters: python python_bindings/filter_scripts/write_scripts.py"""

import os
from pathlib import Path

os.environ["QT_HASH_SEED"] = "0"  # the order of attributes in the files

import numpy as np  # noqa: E402
import pymeshlab  # noqa: E402
import pymeshlab_curvature_lines  # noqa: E402, F401

FOLDER = Path(__file__).parent
CLEANING = [
    ("compute_selection_point_cloud_outliers_by_curvature", {"delete_selected": True}),
    ("apply_coord_point_cloud_robust_denoising", {}),
]
SCRIPTS = {
    "pipeline": [("generate_surface_reconstruction_curvature_aligned", {})],
    "cleaning": CLEANING,
    "lines": [*CLEANING, ("compute_curvature_robust_per_vertex", {}), ("generate_curvature_lines", {})],
}


def ellipsoid() -> pymeshlab.MeshSet:
    """Something all filters run on: a host writes scripts of what was done, not of what could be."""
    turn = np.arange(500) * np.pi * (3 - 5**0.5)
    z = (np.arange(500) + 0.5) / 250 - 1
    sphere = np.column_stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z])
    axes = np.array([1.0, 0.7, 0.5])
    normals = sphere / axes
    meshes = pymeshlab.MeshSet()
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    meshes.add_mesh(pymeshlab.Mesh(sphere * axes, v_normals_matrix=normals))
    return meshes


def write(name: str, folder: Path = FOLDER) -> Path:
    """Writes one of SCRIPTS; returns its file."""
    meshes = ellipsoid()
    for function, parameters in SCRIPTS[name]:
        meshes.apply_filter(function, **parameters)
    file = folder / f"{name}.mlx"
    meshes.save_filter_script(str(file))
    return file


if __name__ == "__main__":
    for script in SCRIPTS:
        print(write(script))
