# Our filters on a cloud, with what they leave behind and the time they took.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import pymeshlab

from harness.results import Estimate
from harness.shared import CURVATURE, layer


@dataclass(frozen=True)
class Ran:
    """A filter that has run."""

    meshes: pymeshlab.MeshSet
    report: dict[str, float]  # what the filter says of it
    seconds: float  # wall clock
    processor_seconds: float  # of all threads

    # Arrays of the current layer, no pymeshlab.Mesh: that would not keep the layers alive.
    @property
    def vertices(self) -> np.ndarray:
        """N x 3."""
        return self.meshes.current_mesh().vertex_matrix()

    @property
    def normals(self) -> np.ndarray:
        """N x 3."""
        return self.meshes.current_mesh().vertex_normal_matrix()

    @property
    def directions(self) -> np.ndarray:
        """N x 3: the first principal direction."""
        return self.meshes.current_mesh().vertex_curvature_principal_dir1_matrix()

    @property
    def colors(self) -> np.ndarray:
        """N x 4."""
        return self.meshes.current_mesh().vertex_color_matrix()

    @property
    def selected(self) -> np.ndarray:
        """Mask of the N vertices."""
        return self.meshes.current_mesh().vertex_selection_array()

    @property
    def edges(self) -> np.ndarray:
        """E x 2 indices of vertices."""
        return self.meshes.current_mesh().edge_matrix()

    @property
    def polygons(self) -> list[np.ndarray]:
        """Indices of vertices, of each face in order around."""
        return self.meshes.current_mesh().polygonal_face_list()

    def attribute(self, name: str) -> np.ndarray:
        """A number per vertex."""
        return self.meshes.current_mesh().vertex_custom_scalar_attribute_array(name)


def run_on(meshes: pymeshlab.MeshSet, filter_name: str, **parameters: object) -> Ran:
    """On layers that exist."""
    wall, processor = time.perf_counter(), time.process_time()
    report = meshes.apply_filter(filter_name, **parameters)
    return Ran(meshes, report or {}, time.perf_counter() - wall, time.process_time() - processor)


def run_filter(filter_name: str, positions: np.ndarray, normals: np.ndarray, **parameters: object) -> Ran:
    """On a cloud (N x 3 each) in a layer of its own."""
    return run_on(layer(positions, normals), filter_name, **parameters)


def curvature_estimate(ran: Ran) -> Estimate:
    """Of :data:`CURVATURE` that has run; the normals are those of the layer afterwards."""
    k1 = ran.attribute("curv_k1")
    return Estimate(
        np.arange(len(k1)),
        k1,
        ran.attribute("curv_k2"),
        ran.directions,
        ran.normals,
        ran.seconds / len(k1),
    )


def robust_curvature(positions: np.ndarray, normals: np.ndarray, **parameters: object) -> Estimate:
    return curvature_estimate(run_filter(CURVATURE, positions, normals, **parameters))
