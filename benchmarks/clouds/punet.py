# Clouds of the denoising set of PU-Net: noisy samples without normals, clean ones, and the mesh both are of.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pymeshlab

FOLDER = "punet"
# Points, noise as a share of the radius of the bounding sphere.
SERIES = [(10000, 0.0), (10000, 0.01), (10000, 0.02), (10000, 0.03), (50000, 0.01), (50000, 0.02)]


@dataclass(frozen=True)
class PublicCloud:
    """One cloud of the set (N points) and its truth."""

    name: str
    positions: np.ndarray  # N x 3
    clean: np.ndarray  # N x 3: the same points without noise
    vertices: np.ndarray  # V x 3 of the true mesh
    triangles: np.ndarray  # T x 3

    @cached_property
    def outward(self) -> np.ndarray:
        """N x 3: normals of the mesh where the points were before noise. Its triangles all look outward."""
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(self.vertices, self.triangles))
        meshes.compute_normal_per_vertex()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=self.clean))
        meshes.transfer_attributes_per_vertex(sourcemesh=0, targetmesh=1, normaltransfer=True, colortransfer=False)
        return meshes.mesh(1).vertex_normal_matrix()


def shapes_in(data: Path | None) -> list[Path]:
    """The files of the set; none without a data folder."""
    return sorted((data / FOLDER).glob("*.npz")) if data else []


def public_cloud(file: Path, count: int, noise: float) -> PublicCloud:
    arrays = np.load(file)
    clean = arrays[f"clean_{count}"].astype(float)
    return PublicCloud(
        file.stem,
        arrays[f"noisy_{count}_{noise:g}"].astype(float) if noise > 0.0 else clean,
        clean,
        arrays["mesh_vertices"].astype(float),
        arrays["mesh_triangles"].astype(np.int32),
    )
