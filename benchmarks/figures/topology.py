# How the faces of a polygon mesh hang together, counted here: edges, components, rims, what is not manifold.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from clouds.scans import loaded

SPECK = 0.01  # of the faces of a file: smaller components are not counted


class DisjointSets:
    def __init__(self) -> None:
        self._parent: dict[Hashable, Hashable] = {}

    def find(self, item: Hashable) -> Hashable:
        self._parent.setdefault(item, item)
        while self._parent[item] != item:
            self._parent[item] = item = self._parent[self._parent[item]]
        return item

    def join(self, a: Hashable, b: Hashable) -> None:
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
    """Pairs of vertices (the smaller index first), with the number of faces at each. Faces: indices of vertices."""
    return Counter((min(a, b), max(a, b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True))


def topology_of(faces: list[np.ndarray]) -> Topology:
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


def topology_of_file(mesh: Path) -> Topology | None:
    """Of the file's own faces without specks; none in a file of points."""
    meshes = loaded(mesh)
    if meshes.current_mesh().face_number() == 0:
        return None
    meshes.meshing_remove_unreferenced_vertices()
    least = max(3, int(SPECK * meshes.current_mesh().face_number()))
    meshes.meshing_remove_connected_component_by_face_number(mincomponentsize=least)
    return topology_of(list(meshes.current_mesh().face_matrix()))
