# Hair, leaves and grass beside surfaces: their points are the outliers.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from clouds.cleaning import Cloud
from clouds.thin_shapes import Points, without_outliers

SURFACE_POINTS = 8000
HAIR_POINTS, LEAVES, POINTS_PER_LEAF = 2000, 400, 8
BLADES, POINTS_PER_BLADE, BLADE_HEIGHT, BLADE_WIDTH = 150, 20, 8.0, 0.15  # heights and widths in spacings


def unit_vectors(count: int, random: np.random.Generator) -> Points:
    vectors = random.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def random_in_ball(count: int, radius: float, random: np.random.Generator) -> Points:
    return radius * random.random((count, 1)) ** (1.0 / 3.0) * unit_vectors(count, random)


def beside(surface: Points, outward: Points, hair: Points, normals: Points, noise: float, seed: int) -> Cloud:
    """``noise``: of the surface, a length. Every point of the hair counts as far from the surface."""
    moved = surface + noise * np.random.default_rng(seed + 1).normal(size=(len(surface), 1)) * outward
    outlier = np.arange(len(surface) + len(hair)) >= len(surface)
    cloud = without_outliers(np.vstack([moved, hair]), np.vstack([outward, normals]))
    return replace(cloud, outlier=outlier, distance=lambda points: np.full(len(points), np.inf), exact_normals=True)


def sphere_and(
    hair: Callable[[float, np.random.Generator], tuple[Points, Points]], noise: float
) -> Callable[[int], Cloud]:
    """A unit sphere, and beside it what ``hair`` makes of the spacing: a ball of points around 0, and their normals."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        outward = unit_vectors(SURFACE_POINTS, random)
        spacing = np.sqrt(4.0 * np.pi / SURFACE_POINTS)
        points, normals = hair(spacing, random)
        reach = 1.0 + np.linalg.norm(points, axis=1).max() + 2.0 * spacing
        return beside(outward, outward, points + [reach, 0.0, 0.0], normals, noise * spacing, seed)

    return make


def ball_of_points(spacing: float, random: np.random.Generator) -> tuple[Points, Points]:
    """As dense as the points of a surface are apart, with random normals."""
    radius = spacing * np.cbrt(HAIR_POINTS * 3.0 / (4.0 * np.pi))
    return random_in_ball(HAIR_POINTS, radius, random), unit_vectors(HAIR_POINTS, random)


def leaves(spacing: float, random: np.random.Generator) -> tuple[Points, Points]:
    """Flat patches of eight points, turned anyhow."""
    radius = 1.2 * spacing * np.cbrt(LEAVES * POINTS_PER_LEAF * 3.0 / (4.0 * np.pi))
    centers, normals = random_in_ball(LEAVES, radius, random), unit_vectors(LEAVES, random)
    normals = np.repeat(normals, POINTS_PER_LEAF, axis=0)
    offsets = spacing * random.normal(size=normals.shape)
    offsets -= np.einsum("ij,ij->i", offsets, normals)[:, None] * normals
    return np.repeat(centers, POINTS_PER_LEAF, axis=0) + offsets, normals


def grass(noise: float) -> Callable[[int], Cloud]:
    """Bent blades on the middle of a unit square, as high as eight spacings of its points; random normals."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        count = SURFACE_POINTS
        spacing = 1.0 / np.sqrt(count)
        ground = np.column_stack([random.random((count, 2)), np.zeros(count)])
        foot, lean = random.uniform(0.3, 0.7, (BLADES, 1, 2)), random.normal(0.0, 0.35, (BLADES, 1, 2))
        along = random.random((BLADES, POINTS_PER_BLADE, 1))
        height = BLADE_HEIGHT * spacing
        across = (
            foot
            + lean * height * along**1.5
            + BLADE_WIDTH * spacing * random.normal(size=(BLADES, POINTS_PER_BLADE, 2))
        )
        blades = np.concatenate([across, height * along], axis=2).reshape(-1, 3)
        return beside(
            ground,
            np.tile([0.0, 0.0, 1.0], (count, 1)),
            blades,
            unit_vectors(len(blades), random),
            noise * spacing,
            seed,
        )

    return make
