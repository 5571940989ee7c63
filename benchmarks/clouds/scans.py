# Clouds from mesh files: those that come with PyMeshLab, and those in the folder that the option --data names.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from pathlib import Path

import numpy as np
import pymeshlab

from harness.shared import MESHLAB_SAMPLES

LARGE_SCAN = "dragon_vrip.ply"  # Stanford 3D Scanning Repository


def found(data: Path | None, *names: str) -> bool:
    """Whether all these files are in the data folder."""
    return data is not None and all((data / name).exists() for name in names)


def loaded(mesh: Path) -> pymeshlab.MeshSet:
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(mesh))
    return meshes


def oriented_vertices(mesh: Path, subdivisions: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in at least one face of a mesh file and their normals (N x 3 each), after subdivisions by Loop's scheme.

    Of a file without faces: its points and the normals it has.
    """
    meshes = loaded(mesh)
    if meshes.current_mesh().face_number() > 0:
        meshes.meshing_remove_unreferenced_vertices()
        for _ in range(subdivisions):
            meshes.meshing_surface_subdivision_loop(iterations=1, threshold=pymeshlab.PercentageValue(0))
        meshes.compute_normal_per_vertex()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().vertex_normal_matrix()


def meshlab_sample(name: str, subdivisions: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """The same of a mesh that comes with PyMeshLab."""
    return oriented_vertices(MESHLAB_SAMPLES / name, subdivisions)
