# PyMeshLab's own curvature of a point cloud (algebraic point-set surfaces). It runs in a child process, without our
# plugin: with its default scale it often brings the process down (PyMeshLab 2025.7).
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from peers.estimate import Estimate, tidy

DEFAULT_SCALE = 2


def apss(positions: np.ndarray, normals: np.ndarray, scale: float) -> Estimate | None:
    """At all points of the cloud; None if the filter crashed."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, estimates = Path(folder) / "cloud.npz", Path(folder) / "estimates.npz"
        np.savez(cloud, positions=positions, normals=normals)
        done = subprocess.run(
            [sys.executable, "-m", "peers.apss", cloud, estimates, str(scale)],
            cwd=Path(__file__).resolve().parent.parent,
            capture_output=True,
            check=False,
        )
        if done.returncode < 0:
            return None
        if done.returncode > 0:
            raise RuntimeError(done.stderr.decode(errors="replace"))
        with np.load(estimates) as found:
            return tidy(
                np.arange(len(positions)),
                found["k1"],
                found["k2"],
                found["d1"],
                found["d2"],
                None,
                float(found["seconds"]) / len(positions),
            )


def _child(cloud: str, estimates: str, scale: float) -> None:
    import pymeshlab

    with np.load(cloud) as given:
        positions, normals = given["positions"], given["normals"]
    found = {}
    for key, quality in (("k1", "K1"), ("k2", "K2")):  # curvature leaves the filter as vertex quality alone
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions, v_normals_matrix=normals))
        start = time.perf_counter()
        meshes.compute_curvature_and_color_apss_per_vertex(filterscale=scale, curvaturetype=quality)
        found.setdefault("seconds", time.perf_counter() - start)
        found[key] = meshes.current_mesh().vertex_scalar_array()
    # K1 has the larger absolute value, and the direction stored as PD2 (2025.7).
    found["d1"] = meshes.current_mesh().vertex_curvature_principal_dir2_matrix()
    found["d2"] = meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    np.savez(estimates, **found)


if __name__ == "__main__":
    _child(sys.argv[1], sys.argv[2], float(sys.argv[3]))
