# Quads from a cloud with what a user has today, in two steps: PyMeshLab's screened Poisson surface, then quads by
# Instant Meshes, by QuadriFlow or by PyMeshLab itself. In child processes: the quad packages can bring theirs down.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pymeshlab

from harness.process_memory import peak_megabytes, reset_peak
from peers.child_process import Arrays, in_child, serve

PACKAGES = ("pynanoinstantmeshes", "pyQuadriFlow")
QUADS = {"instant": "Instant Meshes", "flow": "QuadriFlow", "pairs": "PyMeshLab tri-to-quad"}
CREASE_ANGLES = {"instant": 0.0, "instant_off": -1.0, "instant_30": 30.0}  # degrees; the package's own choice is 0
TRIM = 4.0  # spacings: what Poisson adds further from the points of an open surface


@dataclass(frozen=True)
class RouteMesh:
    vertices: np.ndarray  # N x 3
    faces: list[np.ndarray]  # indices of vertices
    seconds: float
    megabytes: float  # at the peak, above the host with the cloud loaded


def poisson_then_quads(
    positions: np.ndarray,
    normals: np.ndarray,
    quads: str,
    depth: int,
    faces: int,
    spacing: float = 0.0,
    threads: int = 0,
) -> RouteMesh | None:
    """None if it crashed or found nothing.

    ``quads``: a key of QUADS or CREASE_ANGLES; ``spacing`` of the points if the surface is open. ``threads`` of
    Poisson, 0: one per core. The surfaces of more than one differ in their last digits from run to run, and quads of them
    can differ a lot.
    """
    cloud = {"positions": positions, "normals": normals}
    found = in_child("peers.quad_routes", cloud, quads, depth, faces, spacing, threads)
    if found is None or len(found["faces"]) == 0:
        return None
    split = np.split(found["faces"], np.cumsum(found["sizes"])[:-1])
    return RouteMesh(found["vertices"], split, float(found["seconds"]), float(found["megabytes"]))


Mesh = tuple[np.ndarray, Sequence]  # vertices (N x 3), faces


def _poisson(meshes: pymeshlab.MeshSet, depth: int, spacing: float, threads: int) -> None:
    """Adds the surface as a layer; of an open one (spacing > 0) without what is far from the points."""
    meshes.generate_surface_reconstruction_screened_poisson(depth=depth, **({"threads": threads} if threads else {}))
    if spacing <= 0.0:
        return
    surface = meshes.current_mesh_id()
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=surface, refmesh=0, signeddist=False, maxdist=pymeshlab.PercentageValue(100)
    )
    meshes.compute_selection_by_condition_per_face(condselect=f"max(q0, max(q1, q2)) > {TRIM * spacing}")
    meshes.meshing_remove_selected_faces()
    meshes.meshing_remove_unreferenced_vertices()


def _by_pairs(meshes: pymeshlab.MeshSet, faces: int) -> Mesh:
    """Isotropic remeshing to the edge length of so many squares, then pairs of triangles."""
    corners = meshes.current_mesh().vertex_matrix()[meshes.current_mesh().face_matrix()]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    edge = pymeshlab.PureValue(np.sqrt(area / faces * 2.0 / np.sqrt(3.0)))
    meshes.meshing_isotropic_explicit_remeshing(iterations=6, targetlen=edge)
    meshes.meshing_tri_to_quad_by_smart_triangle_pairing()
    try:
        found = meshes.current_mesh().polygonal_face_list()
    except MemoryError:  # what pairing can leave of a trimmed surface
        found = []
    return meshes.current_mesh().vertex_matrix(), found


def _by_instant_meshes(meshes: pymeshlab.MeshSet, faces: int, crease_angle: float) -> Mesh:
    from pynanoinstantmeshes import remesh

    mesh = meshes.current_mesh()
    vertices, triangles = mesh.vertex_matrix().astype(np.float32), mesh.face_matrix().astype(np.uint32)
    # The package always splits every face into four.
    return remesh(vertices, triangles, max(1, faces // 4), creaseAngle=crease_angle, deterministic=True)


def _by_quadriflow(meshes: pymeshlab.MeshSet, faces: int) -> Mesh:
    from pyQuadriFlow.pyQuadriFlow import pyquadriflow

    mesh = meshes.current_mesh()
    vertices, triangles = mesh.vertex_matrix().tolist(), mesh.face_matrix().tolist()
    try:
        flow = pyquadriflow(faces, 0, vertices, triangles, False, False, False, False, False)
    except Exception as failure:  # its own, of no narrower kind
        if "QuadriFlow" not in str(failure):
            raise
        return np.empty((0, 3)), []
    return np.array(flow["vertices"]), flow["faces"]


_BY: dict[str, Callable[[pymeshlab.MeshSet, int], Mesh]] = {
    "flow": _by_quadriflow,
    "pairs": _by_pairs,
    **{key: partial(_by_instant_meshes, crease_angle=angle) for key, angle in CREASE_ANGLES.items()},
}
_MODULES = {"flow": "pyQuadriFlow.pyQuadriFlow", **dict.fromkeys(CREASE_ANGLES, "pynanoinstantmeshes")}


def _child(cloud: Arrays, quads: str, depth: str, faces: str, spacing: str, threads: str) -> Arrays:
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=cloud["positions"], v_normals_matrix=cloud["normals"]))
    if quads in _MODULES:
        importlib.import_module(_MODULES[quads])  # loaded before anything is measured
    reset_peak()
    loaded = peak_megabytes()
    start = time.perf_counter()
    _poisson(meshes, int(depth), float(spacing), int(threads))
    vertices, found = _BY[quads](meshes, int(faces))
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
