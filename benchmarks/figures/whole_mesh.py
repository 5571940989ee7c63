# How a polygon mesh stands for a whole shape: what of the shape is far from it, what of it is far from the shape, how
# good its quads are, whether it hangs together as the shape does.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from clouds import thin_shapes
from clouds.whole_shapes import Shape
from figures.mesh import PolygonMesh, distances
from harness.comparison import Figures
from harness.shared import rms

FACE_SAMPLES = 20000
SAMPLE_SEED = 7
POOR_JACOBIAN = 0.2
INVERTED = -1e-6  # scaled Jacobian, below the rounding of a peer in single precision
FOLD = np.cos(np.radians(150.0))  # of the normals of two faces at an edge
JUDGING_POINTS = 8  # near a face, that say which way it should look
# A sharp rim of the shape is no fold if the faces there are so near to it:
ON_SURFACE = 0.15  # of the root of a face's area, or
ON_POINTS = 0.3  # of the spacing of the points
ALONG_AXIS = np.cos(np.radians(45.0))  # of an edge and the fillet it runs along


@dataclass(frozen=True)
class Faces:
    """Of a mesh: areas, normals, centres, and what lies at each edge."""

    mesh: PolygonMesh

    @cached_property
    def area_vectors(self) -> np.ndarray:
        """F x 3: normals as long as the area, of polygons that need not be flat."""
        found = np.empty((len(self.mesh.faces), 3))
        for place, face in enumerate(self.mesh.faces):
            ring = self.mesh.vertices[face] - self.mesh.vertices[face[0]]
            found[place] = 0.5 * np.cross(ring[1:-1], ring[2:]).sum(axis=0)
        return found

    @cached_property
    def areas(self) -> np.ndarray:
        return np.linalg.norm(self.area_vectors, axis=1)

    @cached_property
    def normals(self) -> np.ndarray:
        return self.area_vectors / np.maximum(self.areas, 1e-300)[:, None]

    @cached_property
    def centers(self) -> np.ndarray:
        return np.array([self.mesh.vertices[face].mean(axis=0) for face in self.mesh.faces])

    @cached_property
    def pairs(self) -> np.ndarray:
        """P x 2: faces on both sides of an edge."""
        sides = [
            (min(a, b), max(a, b), place)
            for place, face in enumerate(self.mesh.faces)
            for a, b in zip(face, np.roll(face, -1), strict=True)
        ]
        order = np.array(sorted(sides), dtype=int).reshape(-1, 3)
        same = (order[1:, :2] == order[:-1, :2]).all(axis=1)
        return np.column_stack([order[:-1, 2][same], order[1:, 2][same]])


def folded_faces(shape: Shape, mesh: PolygonMesh) -> np.ndarray:
    """Mask: faces that look against each of the points nearest to them; of the others, those against a neighbour over an edge.

    A rim of the shape itself may be as sharp: not folded are two faces there that lie on the surface and look as one of
    the points near each of them does.
    """
    faces = Faces(mesh)
    near = shape.nearest.indices(faces.centers, JUDGING_POINTS)
    agreement = np.einsum("fkx,fx->fk", shape.normals[near], faces.normals).max(axis=1)
    folded = agreement < 0.0
    first, second = faces.pairs.T
    sharp = np.einsum("ij,ij->i", faces.normals[first], faces.normals[second]) < FOLD
    at_edge = np.unique(faces.pairs[sharp])
    right = np.zeros(len(mesh.faces), bool)
    if len(at_edge):
        reach = np.maximum(ON_SURFACE * np.sqrt(faces.areas[at_edge]), ON_POINTS * shape.spacing)
        on_surface = shape.distance(faces.centers[at_edge]) < reach
        right[at_edge] = on_surface & (agreement[at_edge] > 0.5)
    explained = (right[first] & right[second]) | folded[first] | folded[second]
    wrong = sharp & ~explained
    folded[faces.pairs[wrong].ravel()] = True
    return folded


def scaled_jacobians(mesh: PolygonMesh) -> np.ndarray:
    """Of every quad: the smallest sine of its corners against its own normal, -1 to 1 (1: a rectangle)."""
    quads = np.array([face for face in mesh.faces if len(face) == 4], dtype=int).reshape(-1, 4)
    corners = mesh.vertices[quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    turned = np.cross(ahead, back)
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    lengths = np.linalg.norm(ahead, axis=2) * np.linalg.norm(back, axis=2)
    scale = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    return (np.einsum("qkx,qx->qk", turned, normal) / np.maximum(lengths, 1e-300) / scale[:, None]).min(axis=1)


def irregular(mesh: PolygonMesh) -> float:
    """Inner vertices of a valence other than 4, per 1000 inner ones."""
    valence = np.bincount(np.array(list(mesh.edges)).ravel(), minlength=len(mesh.vertices))
    inner = (valence > 0) & ~mesh.on_rim
    return 1000.0 * float(np.mean(valence[inner] != 4)) if inner.any() else np.nan


def edge_lengths(mesh: PolygonMesh) -> np.ndarray:
    ends = mesh.vertices[np.array(list(mesh.edges))]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


def points_on_faces(mesh: PolygonMesh) -> np.ndarray:
    """Random points of even density."""
    random = np.random.default_rng(SAMPLE_SEED)
    corners = mesh.vertices[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[random.choice(len(area), FACE_SAMPLES, p=area / area.sum())]
    root, share = np.sqrt(random.random((FACE_SAMPLES, 1))), random.random((FACE_SAMPLES, 1))
    return (1.0 - root) * chosen[:, 0] + root * (1.0 - share) * chosen[:, 1] + root * share * chosen[:, 2]


def structure_figures(shape: Shape, mesh: PolygonMesh) -> Figures:
    found, right = mesh.topology, shape.structure
    figures: Figures = {
        "vertices": found.vertices,
        "faces": found.faces,
        "parts": found.components,
        "χ": found.euler_characteristic,
        "rims": found.boundary_loops,
        "non-manifold": found.nonmanifold_edges + found.nonmanifold_vertices,
    }
    if right:
        held = (found.components, found.euler_characteristic, found.boundary_loops)
        as_it_is = held == (right.components, right.euler_characteristic, right.rims)
        figures["wrong structure"] = float(not as_it_is or figures["non-manifold"] > 0)
    return figures


def distance_figures(shape: Shape, mesh: PolygonMesh) -> Figures:
    percent = 100.0 / shape.diagonal
    cloud = percent * distances(shape.truth, mesh.vertices, mesh.triangles)
    faces = percent * shape.distance(points_on_faces(mesh))
    used = np.unique(np.concatenate(mesh.faces))
    corners = percent * shape.distance(mesh.vertices[used])
    return {
        "c rms": rms(cloud),
        "c max": float(cloud.max()),
        "a rms": rms(faces),
        "a max": float(max(faces.max(), corners.max())),
    }


def quality_figures(shape: Shape, mesh: PolygonMesh) -> Figures:
    jacobians = scaled_jacobians(mesh)
    short, long = np.percentile(edge_lengths(mesh), [5, 95])
    figures = {"irregular": irregular(mesh), "quads": 100.0 * mesh.topology.quad_share}
    if len(jacobians):
        figures["sj min"] = float(jacobians.min())
        figures["sj < 0"] = 100.0 * float(np.mean(jacobians < INVERTED))
        figures["sj < .2"] = 100.0 * float(np.mean(jacobians < POOR_JACOBIAN))
    figures["folded"] = float(folded_faces(shape, mesh).sum())
    figures["ratio"] = float(long / short) if short > 0.0 else np.inf
    return figures


def rim_figures(shape: Shape, mesh: PolygonMesh) -> Figures:
    """Of the rim's vertices from the surface, in edges of the mesh."""
    if not mesh.on_rim.any():
        return {}
    off = shape.distance(mesh.vertices[mesh.on_rim]) / float(np.median(edge_lengths(mesh)))
    return {"rim rms": rms(off), "rim max": float(off.max())}


def fillet_angles(mesh: PolygonMesh) -> np.ndarray:
    """Degrees between the edges along the rounded edges of the box and their axes."""
    ends = mesh.vertices[np.array(list(mesh.edges))]
    beyond = np.abs(ends.mean(axis=1)) - thin_shapes.BOX_CORE
    rounded = (beyond > -0.5 * thin_shapes.BOX_RADIUS).sum(axis=1) == 2
    axis = np.argmin(beyond, axis=1)
    edges = ends[:, 1] - ends[:, 0]
    cosine = np.abs(np.take_along_axis(edges, axis[:, None], axis=1)[:, 0]) / np.linalg.norm(edges, axis=1)
    return np.degrees(np.arccos(np.clip(cosine[rounded & (cosine > ALONG_AXIS)], 0.0, 1.0)))


def box_figures(shape: Shape, mesh: PolygonMesh) -> Figures:
    """Of vertices from the surface in spacings, and the mean angle along fillets."""
    used = np.unique(np.concatenate(mesh.faces))
    off = shape.distance(mesh.vertices[used]) / thin_shapes.BOX_SPACING
    angles = fillet_angles(mesh)
    return {
        "off rms": rms(off),
        "off max": float(off.max()),
        "fillet angle": float(angles.mean()) if len(angles) else np.nan,
    }


def whole_figures(shape: Shape, mesh: PolygonMesh, structure_alone: bool = False) -> Figures:
    figures = structure_figures(shape, mesh)
    if structure_alone:
        return figures
    figures |= distance_figures(shape, mesh) | quality_figures(shape, mesh)
    if shape.is_open:
        figures |= rim_figures(shape, mesh)
    if shape.rounded_box:
        figures |= box_figures(shape, mesh)
    return figures
