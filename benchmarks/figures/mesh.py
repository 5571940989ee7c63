# What is right and wrong about a polygon mesh of an exact surface: topology, alignment, distances, rims and edges.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pymeshlab

from clouds.true_curves import along, cube_edges, true_rim
from figures.surface import distance_to_surface, largest_in_percent, mean_angle_to_principal_directions, rms_distance
from figures.topology import Topology, topology_of, unique_edges
from harness.comparison import Figures
from harness.our_filters import Ran
from harness.shared import analytic_surfaces, rms

SUBDIVISIONS = 8  # of the sides of triangles, where a face's distance is looked for
SURFACE_SAMPLES = 20000
EDGE_SAMPLES = 32  # points that stand for an edge of the mesh
RIM_LOOPS = {"helicoid": 1, "cylinder": 2, "half_torus": 2}


@dataclass(frozen=True)
class PolygonMesh:
    vertices: np.ndarray  # N x 3
    faces: list[np.ndarray]  # indices of vertices, each in order around

    @staticmethod
    def of(ran: Ran) -> PolygonMesh:
        """The current layer after a filter."""
        return PolygonMesh(ran.vertices, ran.polygons)

    @cached_property
    def topology(self) -> Topology:
        return topology_of(self.faces)

    @cached_property
    def edges(self) -> Counter:
        return unique_edges(self.faces)

    @cached_property
    def rim(self) -> np.ndarray:
        """Edges of one face."""
        return np.array([edge for edge, count in self.edges.items() if count == 1], dtype=int).reshape(-1, 2)

    @cached_property
    def on_rim(self) -> np.ndarray:
        mask = np.zeros(len(self.vertices), bool)
        mask[self.rim.ravel()] = True
        return mask

    @cached_property
    def triangles(self) -> np.ndarray:
        """Quads cut along the shorter diagonal, larger faces from their first corner."""
        found = []
        for face in self.faces:
            if len(face) == 4:
                a, b, c, d = self.vertices[face]
                face = np.roll(face, -1) if np.linalg.norm(b - d) < np.linalg.norm(a - c) else face
            found += [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
        return np.array(found, dtype=int).reshape(-1, 3)


def distances(points: np.ndarray, vertices: np.ndarray, triangles: np.ndarray | None = None) -> np.ndarray:
    """From points to the nearest point of a mesh, or to the nearest of other points."""
    meshes = pymeshlab.MeshSet()
    faces = {} if triangles is None else {"face_matrix": triangles}
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=vertices, **faces))
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=1, refmesh=0, signeddist=False, maxdist=pymeshlab.PercentageValue(100)
    )
    return np.abs(meshes.mesh(1).vertex_scalar_array())


def face_samples(mesh: PolygonMesh) -> tuple[np.ndarray, np.ndarray]:
    """Points all over the faces, corners and sides among them, and the area each stands for."""
    n = SUBDIVISIONS
    shares = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
    corners = mesh.vertices[mesh.triangles]
    points = np.einsum("sk,tkx->tsx", shares, corners).reshape(-1, 3)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    # The trapezoidal rule: a corner belongs to one of six small triangles around a point inside, a side to three.
    weight = np.where((shares == 0.0).sum(axis=1) == 2, 1.0, np.where((shares == 0.0).any(axis=1), 3.0, 6.0))
    return points, np.outer(area, weight / weight.sum()).ravel()


def mean_angle(surface: str, mesh: PolygonMesh) -> float:
    inner = [edge for edge in mesh.edges if not (mesh.on_rim[edge[0]] and mesh.on_rim[edge[1]])]
    return mean_angle_to_principal_directions(surface, mesh.vertices, np.array(inner))


def four_valent(mesh: PolygonMesh) -> float:
    """Share of the inner vertices."""
    valence = np.bincount(np.array(list(mesh.edges)).ravel(), minlength=len(mesh.vertices))
    inner = (valence > 0) & ~mesh.on_rim
    return float(np.mean(valence[inner] == 4)) if inner.any() else 0.0


def topology_is_right(surface: str, mesh: PolygonMesh) -> bool:
    shape, truth = mesh.topology, analytic_surfaces.surface(surface)
    manifold = shape.nonmanifold_edges == 0 and shape.nonmanifold_vertices == 0
    rims = shape.boundary_loops == RIM_LOOPS.get(surface, 0)
    return manifold and rims and shape.components == 1 and shape.euler_characteristic == truth.euler_characteristic


def surface_to_mesh(surface: str, mesh: PolygonMesh) -> float:
    samples = analytic_surfaces.generate(surface, SURFACE_SAMPLES, seed=99)["positions"]
    return largest_in_percent(surface, distances(samples, mesh.vertices, mesh.triangles))


def common_figures(surface: str, target: int, mesh: PolygonMesh) -> Figures:
    diagonal = analytic_surfaces.surface(surface).diagonal
    points, areas = face_samples(mesh)
    off = 100.0 * distance_to_surface(surface, points) / diagonal
    figures = {
        "wrong topology": float(not topology_is_right(surface, mesh)),
        "quads, %": 100.0 * mesh.topology.quad_share,
        "valence 4, %": 100.0 * four_valent(mesh),
        "mean distance, %": float(np.average(off, weights=areas)),
        "vertices RMS, %": 100.0 * rms_distance(surface, mesh.vertices) / diagonal,
        "Hausdorff, mesh to surface, %": float(off.max()),
        "Hausdorff, surface to mesh, %": surface_to_mesh(surface, mesh),
    }
    if target:
        figures["count off target, %"] = 100.0 * abs(len(mesh.vertices) / target - 1.0)
    return figures


def rim_distance(surface: str, mesh: PolygonMesh) -> float:
    """The largest of the mesh's rim to the true one and back, % of the diagonal; all of it where there is no rim."""
    if len(mesh.rim) == 0:
        return 100.0
    ours, truth = along(mesh.vertices[mesh.rim], EDGE_SAMPLES), true_rim(surface)
    return max(largest_in_percent(surface, found) for found in (distances(ours, truth), distances(truth, ours)))


def edge_distances(mesh: PolygonMesh) -> Figures:
    """Of the cube's twelve edges from the edges of the mesh: near only where edges of the mesh run along them."""
    ours = along(mesh.vertices[np.array(list(mesh.edges))], EDGE_SAMPLES)
    off = 100.0 * distances(cube_edges(), ours) / analytic_surfaces.surface("cube").diagonal
    return {"edges RMS, %": rms(off), "edges max, %": float(off.max())}
