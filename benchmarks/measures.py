# What the benchmarks share: clouds in and out of PyMeshLab, figures of a result that do not trust the filter's own
# counts, and the Markdown files they end in.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from collections import Counter, defaultdict
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pymeshlab
import pymeshlab_curvature_lines

from peers.estimate import Estimate

CHECKOUT = Path(__file__).resolve().parent.parent
RESULTS = CHECKOUT / "benchmarks" / "results"
sys.path.insert(0, str(CHECKOUT / "sample_data"))

import analytic_surfaces  # noqa: E402

MESHLAB_SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"


def layer(positions: np.ndarray, normals: np.ndarray) -> pymeshlab.MeshSet:
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions, v_normals_matrix=normals))
    return meshes


def meshlab_sample(name: str, subdivisions: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and vertex normals of a mesh that comes with PyMeshLab, its faces forgotten."""
    return oriented_vertices(MESHLAB_SAMPLES / name, subdivisions)


def oriented_vertices(mesh: Path, subdivisions: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in at least one face of a mesh file, and their normals."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(mesh))
    meshes.meshing_remove_unreferenced_vertices()
    for _ in range(subdivisions):
        meshes.meshing_surface_subdivision_loop(iterations=1, threshold=pymeshlab.PercentageValue(0))
    meshes.compute_normal_per_vertex()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().vertex_normal_matrix()


def robust_curvature(positions: np.ndarray, normals: np.ndarray, **parameters) -> Estimate:
    """Our filter on a cloud; its normals are those of the layer afterwards."""
    return estimated(layer(positions, normals), **parameters)


def estimated(meshes: pymeshlab.MeshSet, **parameters) -> Estimate:
    """The same on the current layer, for those who want to see what else it carries afterwards."""
    start = time.perf_counter()
    meshes.compute_curvature_robust_per_vertex(**parameters)
    seconds = time.perf_counter() - start
    mesh = meshes.current_mesh()
    return Estimate(
        np.arange(mesh.vertex_number()),
        mesh.vertex_custom_scalar_attribute_array("curv_k1"),
        mesh.vertex_custom_scalar_attribute_array("curv_k2"),
        mesh.vertex_curvature_principal_dir1_matrix(),
        mesh.vertex_normal_matrix(),
        seconds / mesh.vertex_number(),
    )


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def angle_between_lines(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles (radians) between rows of unit vectors whose sign means nothing."""
    return np.arccos(np.minimum(1.0, np.abs(np.einsum("ij,ij->i", a, b))))


class DisjointSets:
    def __init__(self) -> None:
        self._parent: dict = {}

    def find(self, item):
        self._parent.setdefault(item, item)
        while self._parent[item] != item:
            self._parent[item] = item = self._parent[self._parent[item]]
        return item

    def join(self, a, b) -> None:
        self._parent[self.find(a)] = self.find(b)

    def count(self) -> int:
        return len({self.find(item) for item in list(self._parent)})


@dataclass(frozen=True)
class Topology:
    vertices: int  # in at least one face
    edges: int
    faces: int
    quads: int
    components: int
    boundary_edges: int
    boundary_loops: int
    nonmanifold_edges: int
    nonmanifold_vertices: int

    @property
    def euler_characteristic(self) -> int:
        return self.vertices - self.edges + self.faces

    @property
    def quad_share(self) -> float:
        return self.quads / self.faces if self.faces else 0.0


def unique_edges(faces: list[np.ndarray]) -> Counter:
    """Vertex pairs, with the number of faces at each."""
    return Counter(
        (min(a, b), max(a, b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)
    )


def topology(faces: list[np.ndarray]) -> Topology:
    edges = unique_edges(faces)
    boundary = [edge for edge, count in edges.items() if count == 1]

    pieces, rims = DisjointSets(), DisjointSets()
    for a, b in edges:
        pieces.join(a, b)
    for a, b in boundary:
        rims.join(a, b)

    # The faces at a vertex are one fan if its corners hang together by shared edges.
    corners: dict[int, DisjointSets] = defaultdict(DisjointSets)
    for face in faces:
        for before, vertex, after in zip(np.roll(face, 1), face, np.roll(face, -1), strict=True):
            corners[int(vertex)].join(int(before), int(after))

    return Topology(
        vertices=len(corners),
        edges=len(edges),
        faces=len(faces),
        quads=sum(len(face) == 4 for face in faces),
        components=pieces.count(),
        boundary_edges=len(boundary),
        boundary_loops=rims.count(),
        nonmanifold_edges=sum(count > 2 for count in edges.values()),
        nonmanifold_vertices=sum(fans.count() > 1 for fans in corners.values()),
    )


def mean_angle_to_principal_directions(surface: str, vertices: np.ndarray, ends: np.ndarray) -> float:
    """Degrees between mesh edges (pairs of vertices) and the nearer principal direction at the foot of their middle."""
    first, second = vertices[ends[:, 0]], vertices[ends[:, 1]]
    truth = analytic_surfaces.project(surface, 0.5 * (first + second))
    edges = second - first
    edges -= np.einsum("ij,ij->i", edges, truth["normals"])[:, None] * truth["normals"]
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    nearer = np.minimum(angle_between_lines(edges, truth["d1"]), angle_between_lines(edges, truth["d2"]))
    return float(np.degrees(nearer.mean()))


def distance_to_surface(surface: str, points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points - analytic_surfaces.project(surface, points)["foot_points"], axis=1)


def markdown_table(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def commit() -> str:
    described = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=CHECKOUT, capture_output=True, text=True, check=False
    )
    return described.stdout.strip() or "unknown"


def write_result(name: str, script: str, title: str, body: str) -> None:
    """A result file says which command, versions and machine it came from."""
    RESULTS.mkdir(exist_ok=True)
    text = (
        f"# {title}\n\n"
        f"Written by `.venv/bin/python benchmarks/{script}`; plugin {pymeshlab_curvature_lines.__version__}, "
        f"commit {commit()}, "
        f"PyMeshLab {version('pymeshlab')}, {os.environ.get('OMP_NUM_THREADS', os.cpu_count())} threads (OpenMP), "
        f"{platform.machine()}.\n\n"
        f"{body}"
    )
    (RESULTS / f"{name}.md").write_text(text, encoding="utf-8")
    print(text)
