# Quads from a cloud with what a user has today, in two steps: PyMeshLab's screened Poisson surface, then quads by
# Instant Meshes, by QuadriFlow or by PyMeshLab itself. In child processes: the quad packages can bring theirs down.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from peers.child_process import Arrays, in_child, serve

PACKAGES = ("pynanoinstantmeshes", "pyQuadriFlow")
QUADS = {"instant": "Instant Meshes", "flow": "QuadriFlow", "pairs": "PyMeshLab tri-to-quad"}
TRIM = 4.0  # spacings: what Poisson adds further from the points of an open surface


@dataclass(frozen=True)
class RouteMesh:
    vertices: np.ndarray
    faces: list[np.ndarray]
    seconds: float
    megabytes: float  # at the peak, above the host with the cloud loaded


def poisson_then_quads(
    positions: np.ndarray, normals: np.ndarray, quads: str, depth: int, faces: int, spacing: float = 0.0
) -> RouteMesh | None:
    """``quads``: a key of QUADS; ``spacing`` of the points if the surface is open. None if it crashed or found nothing."""
    cloud = {"positions": positions, "normals": normals}
    found = in_child("peers.quad_routes", cloud, quads, depth, faces, spacing)
    if found is None or len(found["faces"]) == 0:
        return None
    split = np.split(found["faces"], np.cumsum(found["sizes"])[:-1])
    return RouteMesh(found["vertices"], split, float(found["seconds"]), float(found["megabytes"]))


def _child(cloud: Arrays, quads: str, depth: str, faces: str, spacing: str) -> Arrays:
    import pymeshlab

    from process_memory import peak_megabytes, reset_peak

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=cloud["positions"], v_normals_matrix=cloud["normals"]))
    if quads == "instant":
        from pynanoinstantmeshes import remesh
    elif quads == "flow":
        from pyQuadriFlow.pyQuadriFlow import pyquadriflow
    reset_peak()
    loaded = peak_megabytes()
    start = time.perf_counter()
    meshes.generate_surface_reconstruction_screened_poisson(depth=int(depth))
    if float(spacing) > 0.0:
        surface = meshes.current_mesh_id()
        meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
            measuremesh=surface, refmesh=0, signeddist=False, maxdist=pymeshlab.PercentageValue(100)
        )
        meshes.compute_selection_by_condition_per_face(condselect=f"max(q0, max(q1, q2)) > {TRIM * float(spacing)}")
        meshes.meshing_remove_selected_faces()
        meshes.meshing_remove_unreferenced_vertices()
    vertices, triangles = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    if quads == "pairs":
        # Isotropic remeshing to the edge length of so many squares, then pairs of triangles.
        corners = vertices[triangles]
        area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
        edge = pymeshlab.PureValue(np.sqrt(area / int(faces) * 2.0 / np.sqrt(3.0)))
        meshes.meshing_isotropic_explicit_remeshing(iterations=6, targetlen=edge)
        meshes.meshing_tri_to_quad_by_smart_triangle_pairing()
        try:
            found = meshes.current_mesh().polygonal_face_list()
        except MemoryError:  # what pairing can leave of a trimmed surface
            found = []
        vertices = meshes.current_mesh().vertex_matrix()
    elif quads == "instant":
        # The package always splits every face into four.
        vertices, found = remesh(
            vertices.astype(np.float32), triangles.astype(np.uint32), max(1, int(faces) // 4), deterministic=True
        )
    else:
        try:
            flow = pyquadriflow(int(faces), 0, vertices.tolist(), triangles.tolist(), False, False, False, False, False)
        except Exception as failure:  # its own, of no narrower kind
            if "QuadriFlow" not in str(failure):
                raise
            flow = {"vertices": [], "faces": []}
        vertices, found = np.array(flow["vertices"]), flow["faces"]
    seconds, megabytes = time.perf_counter() - start, peak_megabytes() - loaded
    return {
        "vertices": np.asarray(vertices, dtype=float).reshape(-1, 3),
        "faces": np.concatenate([np.asarray(face, dtype=int) for face in found]) if len(found) else np.empty(0, int),
        "sizes": np.array([len(face) for face in found], dtype=int),
        "seconds": np.array(seconds),
        "megabytes": np.array(megabytes),
    }


if __name__ == "__main__":
    serve(_child)
