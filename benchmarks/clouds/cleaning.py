# The clouds of the table of cleaning, with outliers and noise, and the truth about them.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pymeshlab

from clouds.generated import PLANE_FIT_NEIGHBORS
from clouds.scans import loaded
from clouds.spacing import nearest_neighbor_distances
from harness.shared import analytic_surfaces

SMOOTH_NORMALS_NEIGHBORS = 100  # best known for the peers that live on their normals
SMALLEST_NOISE_UNIT = 0.0025  # of the diagonal
EDGE_ZONE = 0.05  # of the cube's side


@dataclass(frozen=True)
class Cloud:
    """What the methods get (N points), the truth, and the parts the figures are of."""

    positions: np.ndarray  # N x 3
    outward: np.ndarray  # N x 3: true normals, only to say which side is outside
    outlier: np.ndarray  # mask: those put in as outliers
    noise_unit: np.ndarray  # standard deviation of the noise, per point, at least the smallest unit
    distance: Callable[[np.ndarray], np.ndarray]  # signed, of moved positions (all points) from the surface
    parts: dict[str, np.ndarray]  # name: mask of points
    rim_distance: Callable[[np.ndarray], np.ndarray] | None = None  # of the foot points, where there is a rim
    exact_normals: bool = False  # planes through neighbours of a single scan line say nothing

    @cached_property
    def normals(self) -> np.ndarray:
        if self.exact_normals:
            return self.outward
        return analytic_surfaces.plane_fit_normals(self.positions, self.outward, PLANE_FIT_NEIGHBORS)

    @cached_property
    def smooth_normals(self) -> np.ndarray:
        return analytic_surfaces.plane_fit_normals(self.positions, self.outward, SMOOTH_NORMALS_NEIGHBORS)

    @cached_property
    def distance_before(self) -> np.ndarray:
        return self.distance(self.positions)

    @cached_property
    def spacing(self) -> float:
        """Twice the median distance of nearest neighbours: the side of the square each of random points has."""
        return 2.0 * float(np.median(nearest_neighbor_distances(self.positions)))

    def only(self, chosen: np.ndarray, parts: dict[str, np.ndarray]) -> Cloud:
        """A part of the cloud on its own."""

        def distance(moved: np.ndarray) -> np.ndarray:
            everywhere = self.positions.copy()
            everywhere[chosen] = moved
            return self.distance(everywhere)[chosen]

        return replace(
            self,
            positions=self.positions[chosen],
            outward=self.outward[chosen],
            outlier=self.outlier[chosen],
            noise_unit=self.noise_unit[chosen],
            distance=distance,
            parts={name: mask[chosen] for name, mask in parts.items()},
        )


def signed_distance(surface: str) -> Callable[[np.ndarray], np.ndarray]:
    def distance(points: np.ndarray) -> np.ndarray:
        truth = analytic_surfaces.project(surface, points)
        offsets = points - truth["foot_points"]
        sides = np.where(np.einsum("ij,ij->i", offsets, truth["normals"]) < 0.0, -1.0, 1.0)
        return sides * np.linalg.norm(offsets, axis=1)

    return distance


def sampled(surface: str, points: int, noise: float, far: float = 0.0, near: float = 0.0) -> Callable[[int], Cloud]:
    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate(surface, points, noise=noise, outliers=far, near_outliers=near, seed=seed)
        parts = {"": np.ones(len(made["positions"]), bool)}
        if surface == "cube":
            edge = made["feature_distance"] < EDGE_ZONE
            parts = {"edges": edge, "elsewhere": ~edge}
        unit = max(noise, SMALLEST_NOISE_UNIT) * analytic_surfaces.surface(surface).diagonal
        return Cloud(
            made["positions"],
            made["normals"],
            made["label"] != analytic_surfaces.INLIER,
            np.full(len(made["positions"]), unit),
            signed_distance(surface),
            parts,
            None if analytic_surfaces.surface(surface).closed else rim_distance_of(surface),
        )

    return make


def rim_distance_of(surface: str) -> Callable[[np.ndarray], np.ndarray]:
    return lambda points: analytic_surfaces.project(surface, points)["rim_distance"]


def grooved(points: int, width: float) -> Callable[[int], Cloud]:
    """A sheet of side 1 with a valley of Gaussian profile: depth and half width at 1/e are `width` spacings."""
    size = width / np.sqrt(points)

    def profile(x: np.ndarray) -> np.ndarray:
        return -size * np.exp(-(((x - 0.5) / size) ** 2))

    def slope(x: np.ndarray) -> np.ndarray:
        return -2.0 * (x - 0.5) / size**2 * profile(x)

    def distance(moved: np.ndarray) -> np.ndarray:
        return (moved[:, 2] - profile(moved[:, 0])) / np.hypot(1.0, slope(moved[:, 0]))

    def make(seed: int) -> Cloud:
        x, y = np.random.default_rng(seed).random((2, points))
        outward = np.column_stack([-slope(x), np.zeros(points), np.ones(points)])
        groove = np.abs(x - 0.5) < 2.0 * size
        return Cloud(
            np.column_stack([x, y, profile(x)]),
            outward / np.linalg.norm(outward, axis=1, keepdims=True),
            np.zeros(points, bool),
            np.full(points, SMALLEST_NOISE_UNIT),
            distance,
            {"groove": groove, "elsewhere": ~groove},
        )

    return make


WAVE_SIDE, WAVE_HEIGHT, WAVE_LENGTH, WAVE_STEP = 30.0, 1.2, 15.0, 0.1
WAVE_NOISE = 0.02


def scanned(ratio: float, noise: float) -> Callable[[int], Cloud]:
    """A wave on lines along x, ``ratio`` times as far apart as the points of a line; noise along z."""
    w = 2.0 * np.pi / WAVE_LENGTH

    def distance(moved: np.ndarray) -> np.ndarray:
        return moved[:, 2] - WAVE_HEIGHT * np.sin(w * moved[:, 0]) * np.cos(w * moved[:, 1])

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        x, y = np.meshgrid(np.arange(0.0, WAVE_SIDE, WAVE_STEP), np.arange(0.0, WAVE_SIDE, WAVE_STEP * ratio))
        x = (x + random.uniform(0.0, WAVE_STEP, (len(x), 1))).ravel()
        y = y.ravel()
        z = WAVE_HEIGHT * np.sin(w * x) * np.cos(w * y) + random.normal(0.0, 1.0, len(x)) * noise
        slopes = -w * WAVE_HEIGHT * np.array([np.cos(w * x) * np.cos(w * y), -np.sin(w * x) * np.sin(w * y)])
        outward = np.column_stack([*slopes, np.ones(len(x))])
        return Cloud(
            np.column_stack([x, y, z]),
            outward / np.linalg.norm(outward, axis=1, keepdims=True),
            np.zeros(len(x), bool),
            np.full(len(x), WAVE_NOISE),
            distance,
            {"": np.ones(len(x), bool)},
            exact_normals=True,
        )

    return make


def doubled(points: int, noise: float, error: float) -> Callable[[int], Cloud]:
    """A torus and the same points again, each coordinate off by ``error`` spacings."""

    def make(seed: int) -> Cloud:
        one = sampled("torus", points, noise)(seed)
        shift = np.random.default_rng(seed).normal(0.0, error * one.spacing, one.positions.shape)
        twice = {name: np.concatenate([getattr(one, name)] * 2) for name in ("outward", "outlier", "noise_unit")}
        parts = {"": np.ones(2 * len(shift), bool)}
        return replace(one, positions=np.concatenate([one.positions, one.positions + shift]), parts=parts, **twice)

    return make


UNEVEN_SECTORS = 4
UNEVEN_MARGIN = 0.25  # radians at each end of a sector that are handed over but not judged


def uneven(points: int, share: float) -> Callable[[int], Cloud]:
    """A torus along which noise goes from 0.1 to 1 % and density falls tenfold, out of step; parts: quarters."""

    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate("torus", 3 * points, outliers=share, seed=seed)
        random = np.random.default_rng(seed)
        around = np.arctan2(made["positions"][:, 1], made["positions"][:, 0])
        kept = random.random(len(around)) < 10.0 ** (-0.5 * (1.0 - np.sin(around)))
        positions, around = made["positions"][kept], around[kept]
        outlier = made["label"][kept] != analytic_surfaces.INLIER
        noise = 0.001 * analytic_surfaces.surface("torus").diagonal * 10.0 ** (0.5 * (1.0 - np.cos(around)))
        moved = random.normal(size=positions.shape) * noise[:, None]
        positions = positions + np.where(outlier[:, None], 0.0, moved)
        truth = analytic_surfaces.project("torus", positions)
        unit = np.maximum(noise, SMALLEST_NOISE_UNIT * analytic_surfaces.surface("torus").diagonal)
        half = np.pi / UNEVEN_SECTORS - UNEVEN_MARGIN
        parts = {name: away_from(center, around) < half for name, center in sector_centers().items()}
        return Cloud(positions, truth["normals"], outlier, unit, signed_distance("torus"), parts)

    return make


def sector_centers() -> dict[str, float]:
    names = ("low noise", "dense", "high noise", "sparse")
    return {name: 2.0 * np.pi * number / UNEVEN_SECTORS for number, name in enumerate(names)}


def away_from(center: float, around: np.ndarray) -> np.ndarray:
    return np.abs((around - center + np.pi) % (2.0 * np.pi) - np.pi)


def quarters_alone(cloud: Cloud) -> list[Cloud]:
    around = np.arctan2(cloud.positions[:, 1], cloud.positions[:, 0])
    return [
        cloud.only(away_from(center, around) <= np.pi / UNEVEN_SECTORS, {name: cloud.parts[name]})
        for name, center in sector_centers().items()
    ]


def with_clean_mesh(noisy: Path, clean: Path, impulsive: bool = False) -> Cloud:
    """The vertices of a noisy mesh whose clean one has the same order; impulsive: the displaced ones are outliers."""
    meshes = loaded(clean)
    meshes.compute_normal_per_vertex()
    truth = meshes.current_mesh().vertex_matrix()
    outward = meshes.current_mesh().vertex_normal_matrix()
    unit = SMALLEST_NOISE_UNIT * meshes.current_mesh().bounding_box().diagonal()
    meshes.load_new_mesh(str(noisy))
    positions = meshes.current_mesh().vertex_matrix()
    displaced = np.linalg.norm(positions - truth, axis=1)

    def distance(points: np.ndarray) -> np.ndarray:
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
        meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
            measuremesh=meshes.current_mesh_id(), refmesh=0, signeddist=True
        )
        return meshes.current_mesh().vertex_scalar_array()

    outlier = displaced > 1e-3 * unit if impulsive else np.zeros(len(positions), bool)
    return Cloud(
        positions, outward, outlier, np.full(len(positions), unit), distance, {"": np.ones(len(positions), bool)}
    )
