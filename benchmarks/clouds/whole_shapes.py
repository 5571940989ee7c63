# The shapes whose meshes must be whole, to the tips: scans and models from the data folder and exact ones of our own,
# each with the points, the distance to the true surface and how that surface hangs together.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pymeshlab

from clouds import thin_shapes
from clouds.scans import found, loaded, meshlab_sample, oriented_vertices
from clouds.spacing import NearestPoints, median_nearest_distance
from clouds.thin_shapes import REAL_SHAPES, Points

Distance = Callable[[Points], np.ndarray]  # of points (N x 3) from the true surface, not negative

OWN_SPACING_NEIGHBORS = 6
TANGENT_REACH = 2.0  # local spacings from the nearest point: so far its tangent plane stands for the surface


@dataclass(frozen=True)
class Structure:
    """How the true surface hangs together."""

    components: int
    euler_characteristic: int
    rims: int = 0


@dataclass(frozen=True)
class Shape:
    positions: np.ndarray  # N x 3: what the methods get
    normals: np.ndarray  # N x 3, unit, outward
    distance: Distance  # an open surface is continued beyond its rim
    structure: Structure | None = None  # where it is known
    clean: np.ndarray | None = None  # the points without their noise, if that is another cloud
    with_normals: bool = True  # ours gets them, too
    rounded_box: bool = False

    @property
    def truth(self) -> np.ndarray:
        """N x 3: points on the surface."""
        return self.positions if self.clean is None else self.clean

    @cached_property
    def diagonal(self) -> float:
        return float(np.linalg.norm(np.ptp(self.truth, axis=0)))

    @cached_property
    def nearest(self) -> NearestPoints:
        """Among the points of the truth."""
        return NearestPoints(self.truth)

    @cached_property
    def spacing(self) -> float:
        """Random points are twice as far apart as from the nearest one."""
        return 2.0 * median_nearest_distance(self.positions)

    @property
    def is_open(self) -> bool:
        return self.structure is not None and self.structure.rims > 0


def from_profile(profile: Points) -> Distance:
    """Of the surface that a profile (distance from the axis, height) goes round: nearest in the half plane of the point."""
    start, step = profile[:-1], np.diff(profile, axis=0)
    squared = np.einsum("ij,ij->i", step, step)

    def distance(points: Points) -> np.ndarray:
        flat = np.column_stack([np.linalg.norm(points[:, :2], axis=1), points[:, 2]])
        nearest = np.full(len(points), np.inf)
        for origin, along, square in zip(start, step, squared, strict=True):
            if square == 0.0:
                continue
            t = np.clip((flat - origin) @ along / square, 0.0, 1.0)
            np.minimum(nearest, np.linalg.norm(flat - origin - t[:, None] * along, axis=1), out=nearest)
        return nearest

    return distance


def from_ellipsoid(axes: tuple[float, float, float]) -> Distance:
    """The last half axis is the shortest one.

    The foot point of y has the coordinates e² y / (t + e²), e the half axes; t is where these lie on the ellipsoid,
    found by halving an interval (in t / e² + 1 of the shortest axis, which keeps its digits near the medial plane).
    """
    half = np.array(axes)
    ratio = (half / half[-1]) ** 2

    def distance(points: Points) -> np.ndarray:
        y = np.maximum(np.abs(points), 1e-12)
        z = y * half / half[-1] ** 2
        low, high = z[:, -1], np.linalg.norm(z, axis=1)
        for _ in range(100):
            middle = 0.5 * (low + high)
            outside = np.sum((z / (middle[:, None] - 1.0 + ratio)) ** 2, axis=1) > 1.0
            low, high = np.where(outside, middle, low), np.where(outside, high, middle)
        foot = ratio * y / ((0.5 * (low + high))[:, None] - 1.0 + ratio)
        return np.linalg.norm(foot - y, axis=1)

    return distance


def from_rounded_box(points: Points) -> np.ndarray:
    beyond = np.abs(points) - thin_shapes.BOX_CORE
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.abs(outside + np.minimum(beyond.max(axis=1), 0.0) - thin_shapes.BOX_RADIUS)


def from_two_limbs(points: Points) -> np.ndarray:
    limb = from_profile(thin_shapes.capsule_profile(thin_shapes.LIMB_RADIUS))
    return np.minimum(limb(points), limb(points - thin_shapes.LIMB_STEP))


def from_spheres(centers: Points, radius: float) -> Distance:
    nearest = NearestPoints(centers)
    return lambda points: np.abs(nearest.distances(points, 1)[:, 0] - radius)


def from_bumpy_grid(points: Points) -> np.ndarray:
    """Along the normal below or above, to the first order."""
    height, normals = thin_shapes.bumpy_height(points[:, 0], points[:, 1])
    return np.abs(points[:, 2] - height) * normals[:, 2]


def from_pipe(points: Points) -> np.ndarray:
    return np.abs(np.linalg.norm(points[:, :2], axis=1) - thin_shapes.PIPE_RADIUS)


def from_tangent_planes(positions: Points, normals: Points) -> Distance:
    """To the plane of the nearest point; further off than the points are apart there, to the point itself."""
    near = NearestPoints(positions)

    def distance(points: Points) -> np.ndarray:
        which = near.indices(points, 1)[:, 0]
        offset = points - positions[which]
        length = np.linalg.norm(offset, axis=1)
        chosen, back = np.unique(which, return_inverse=True)
        spacing = near.distances(positions[chosen], 1 + OWN_SPACING_NEIGHBORS)[:, 1:].mean(axis=1)[back.ravel()]
        above = np.abs(np.einsum("ij,ij->i", offset, normals[which]))
        return np.where(length < TANGENT_REACH * spacing, above, length)

    return distance


def from_faces(file: Path) -> Distance:
    meshes = loaded(file)
    truth = meshes.current_mesh_id()

    def distance(points: Points) -> np.ndarray:
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
        meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
            measuremesh=meshes.current_mesh_id(),
            refmesh=truth,
            signeddist=False,
            maxdist=pymeshlab.PercentageValue(100),
        )
        return np.abs(meshes.current_mesh().vertex_scalar_array())

    return distance


STRUCTURES = {  # of the real shapes; the scan of the bunny has holes that cannot be told from wide gaps
    "horse": Structure(1, 2),
    "fish": Structure(1, 2),
    "rocker arm": Structure(1, 0),
    "hand": Structure(1, 2),
    "cow": Structure(1, 2),
    "armadillo": Structure(1, 2),
}


def real(name: str, data: Path | None) -> Shape | None:
    """A shape from the data folder, or the chameleon that comes with PyMeshLab; none if it is not there."""
    if name == "chameleon":
        positions, normals = meshlab_sample("chameleon.pts")
        return Shape(positions, normals, from_tangent_planes(positions, normals))
    if data is None or not found(data, REAL_SHAPES[name]):
        return None
    file = data / REAL_SHAPES[name]
    positions, normals = oriented_vertices(file)
    has_faces = loaded(file).current_mesh().face_number() > 0
    distance = from_faces(file) if has_faces else from_tangent_planes(positions, normals)
    return Shape(positions, normals, distance, STRUCTURES.get(name))


@dataclass(frozen=True)
class Exact:
    make: Callable[[int], thin_shapes.Cloud]
    distance: Distance
    structure: Structure = Structure(1, 2)
    clean: Callable[[Points], Points] | None = None  # moves the points onto the surface
    with_normals: bool = True

    def shape(self, seed: int = 1) -> Shape:
        cloud = self.make(seed)
        return Shape(
            cloud.positions,
            cloud.outward,
            self.distance,
            self.structure,
            clean=self.clean(cloud.positions) if self.clean else None,
            with_normals=self.with_normals,
            rounded_box=self.make is thin_shapes.rounded_box,
        )


def onto_pipe(positions: Points) -> Points:
    away = np.linalg.norm(positions[:, :2], axis=1, keepdims=True)
    return np.column_stack([positions[:, :2] * thin_shapes.PIPE_RADIUS / away, positions[:, 2]])


EXACT = {
    "spike": Exact(thin_shapes.cone, from_profile(thin_shapes.cone_profile())),
    "pin_0_1": Exact(thin_shapes.rod(0.1), from_profile(thin_shapes.rod_profile(0.1))),
    "pin_0_05": Exact(thin_shapes.rod(0.05), from_profile(thin_shapes.rod_profile(0.05))),
    "blade": Exact(thin_shapes.blade, from_ellipsoid((1.0, 0.5, 0.05))),
    "rounded_box": Exact(thin_shapes.rounded_box, from_rounded_box),
    "capsule": Exact(thin_shapes.capsule, from_profile(thin_shapes.capsule_profile(0.1))),
    "two_limbs": Exact(thin_shapes.two_limbs, from_two_limbs, Structure(2, 4)),
    "sparse_cap": Exact(thin_shapes.sparse_cap, from_spheres(np.zeros((1, 3)), 1.0)),
    "many_parts": Exact(
        thin_shapes.many_parts,
        from_spheres(thin_shapes.part_centers(), thin_shapes.PART_RADIUS),
        Structure(90, 180),
        with_normals=False,
    ),
    "bumpy_grid": Exact(thin_shapes.bumpy_grid, from_bumpy_grid, Structure(1, 1, rims=1)),
    "pipe": Exact(thin_shapes.pipe, from_pipe, Structure(1, 0, rims=2), clean=onto_pipe),
}
