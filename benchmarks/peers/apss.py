# PyMeshLab's own curvature of a point cloud (algebraic point-set surfaces), without our plugin. In a child process:
# with its default scale it often brings the process down (PyMeshLab 2025.7).
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import time

import numpy as np

from harness.results import Estimate
from peers.child_process import Arrays, in_child, serve
from peers.estimate import tidy

DEFAULT_SCALE = 2


def apss(positions: np.ndarray, normals: np.ndarray, scale: float) -> Estimate | None:
    """At all points of the cloud; None if the filter crashed."""
    found = in_child("peers.apss", {"positions": positions, "normals": normals}, scale)
    if found is None:
        return None
    return tidy(
        np.arange(len(positions)),
        found["k1"],
        found["k2"],
        found["d1"],
        found["d2"],
        None,
        float(found["seconds"]) / len(positions),
    )


def _child(cloud: Arrays, scale: str) -> Arrays:
    import pymeshlab

    found: Arrays = {}
    for key, quality in (("k1", "K1"), ("k2", "K2")):  # curvature leaves the filter as vertex quality alone
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=cloud["positions"], v_normals_matrix=cloud["normals"]))
        start = time.perf_counter()
        meshes.compute_curvature_and_color_apss_per_vertex(filterscale=float(scale), curvaturetype=quality)
        found.setdefault("seconds", np.array(time.perf_counter() - start))
        found[key] = meshes.current_mesh().vertex_scalar_array()
    # K1 has the larger absolute value, and the direction stored as PD2 (2025.7).
    found["d1"] = meshes.current_mesh().vertex_curvature_principal_dir2_matrix()
    found["d2"] = meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    return found


if __name__ == "__main__":
    serve(_child)
