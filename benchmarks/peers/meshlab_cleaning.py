# PyMeshLab's own filters that clean point clouds, without our plugin: projection onto the algebraic point-set surface,
# local outlier probabilities. In a child process: the projection can bring it down (PyMeshLab 2025.7).
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import time

import numpy as np

from harness.results import Moved, Selection
from peers.child_process import Arrays, in_child, serve


def apss_projection(
    positions: np.ndarray, normals: np.ndarray, scale: float, *, one_layer: bool = False
) -> Moved | None:
    """None if the filter crashed, as it does when one layer is both the surface and what is projected."""
    cloud = {"positions": positions, "normals": normals}
    found = in_child("peers.meshlab_cleaning", cloud, "apss", scale, 1 if one_layer else 2)
    return None if found is None else Moved(found["positions"], float(found["seconds"]))


def local_outlier_probabilities(positions: np.ndarray, probability: float, neighbors: int) -> Selection | None:
    found = in_child("peers.meshlab_cleaning", {"positions": positions}, "loop", probability, neighbors)
    return None if found is None else Selection(found["outliers"], float(found["seconds"]))


def _child(cloud: Arrays, method: str, number: str, count: str) -> Arrays:
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    normals = {"v_normals_matrix": cloud["normals"]} if "normals" in cloud else {}
    layers = int(count) if method == "apss" else 1
    for _ in range(layers):
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=cloud["positions"], **normals))
    proxy = layers - 1
    meshes.set_current_mesh(0)  # the projection wants the surface to be the current layer
    start = time.perf_counter()
    if method == "apss":
        meshes.compute_mls_projection_apss(controlmesh=0, proxymesh=proxy, filterscale=float(number))
    else:
        meshes.compute_selection_point_cloud_outliers(propthreshold=float(number), knearest=int(count))
    seconds = np.array(time.perf_counter() - start)
    if method == "apss":
        return {"positions": meshes.mesh(proxy).vertex_matrix(), "seconds": seconds}
    return {"outliers": meshes.current_mesh().vertex_selection_array(), "seconds": seconds}


if __name__ == "__main__":
    serve(_child)
