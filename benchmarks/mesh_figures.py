# What is right and wrong about a polygon mesh of an exact surface: topology, alignment, distances, rims and edges.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import pymeshlab

import measures
from comparison import Figures
from measures import analytic_surfaces

SUBDIVISIONS = 8  # of the sides of triangles, where a face's distance is looked for
SURFACE_SAMPLES = 20000
CURVE_DENSITY = 500  # points per unit length that stand for a true rim or edge
EDGE_SAMPLES = 32  # points that stand for an edge of the mesh
RIM_LOOPS = {"helicoid": 1, "cylinder": 2, "half_torus": 2}


@dataclass(frozen=True)
class PolygonMesh:
    vertices: np.ndarray
    faces: list[np.ndarray]
    report: dict[str, float] = field(default_factory=dict)  # what our filter says of it

    @cached_property
    def topology(self) -> measures.Topology:
        return measures.topology(self.faces)

    @cached_property
    def edges(self) -> Counter:
        return measures.unique_edges(self.faces)

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


def along(ends: np.ndarray, count: int) -> np.ndarray:
    """Points along segments (N x 2 x 3)."""
    t = np.linspace(0.0, 1.0, count)[None, :, None]
    return (ends[:, None, 0] + t * (ends[:, None, 1] - ends[:, None, 0])).reshape(-1, 3)


def circle(radius: float, center: tuple[float, float, float], u: tuple, v: tuple, angles: tuple) -> np.ndarray:
    count = 2 + int(CURVE_DENSITY * radius * abs(angles[1] - angles[0]))
    t = np.linspace(*angles, count)[:, None]
    return np.array(center) + radius * (np.cos(t) * np.array(u, float) + np.sin(t) * np.array(v, float))


def true_rim(surface: str) -> np.ndarray:
    """Points along the rims of an open surface."""
    if surface == "cylinder":
        return np.vstack([circle(0.5, (0, 0, z), (1, 0, 0), (0, 1, 0), (0, 2 * np.pi)) for z in (-1.0, 1.0)])
    if surface == "half_torus":
        return np.vstack([circle(0.4, (x, 0, 0), (1, 0, 0), (0, 0, 1), (0, 2 * np.pi)) for x in (-1.0, 1.0)])
    v = np.linspace(-np.pi, np.pi, int(CURVE_DENSITY * 2 * np.pi))[:, None]
    helices = [np.hstack([u * np.cos(v), u * np.sin(v), 0.5 * v]) for u in (-1.0, 1.0)]
    straight = [along(np.array([[(-1.0, 0, z), (1.0, 0, z)]]), 2 * CURVE_DENSITY) for z in (-0.5 * np.pi, 0.5 * np.pi)]
    return np.vstack(helices + straight)


def cube_edges() -> np.ndarray:
    """Points along the twelve edges."""
    half = (-0.5, 0.5)
    ends = [(np.roll((-0.5, a, b), k), np.roll((0.5, a, b), k)) for k in range(3) for a in half for b in half]
    return along(np.array(ends), CURVE_DENSITY)


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
    return measures.mean_angle_to_principal_directions(surface, mesh.vertices, np.array(inner))


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
    return 100.0 * float(distances(samples, mesh.vertices, mesh.triangles).max()) / analytic_surfaces.surface(surface).diagonal


def common_figures(surface: str, target: int, mesh: PolygonMesh) -> Figures:
    diagonal = analytic_surfaces.surface(surface).diagonal
    points, areas = face_samples(mesh)
    off = 100.0 * measures.distance_to_surface(surface, points) / diagonal
    figures = {
        "wrong topology": float(not topology_is_right(surface, mesh)),
        "quads, %": 100.0 * mesh.topology.quad_share,
        "valence 4, %": 100.0 * four_valent(mesh),
        "mean distance, %": float(np.average(off, weights=areas)),
        "vertices RMS, %": 100.0 * measures.rms(measures.distance_to_surface(surface, mesh.vertices)) / diagonal,
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
    largest = max(distances(ours, truth).max(), distances(truth, ours).max())
    return 100.0 * float(largest) / analytic_surfaces.surface(surface).diagonal


def edge_distances(mesh: PolygonMesh) -> Figures:
    """Of the cube's twelve edges from the edges of the mesh: near only where edges of the mesh run along them."""
    ours = along(mesh.vertices[np.array(list(mesh.edges))], EDGE_SAMPLES)
    off = 100.0 * distances(cube_edges(), ours) / analytic_surfaces.surface("cube").diagonal
    return {"edges RMS, %": measures.rms(off), "edges max, %": float(off.max())}
