# The clouds behind the figures of Kalogerakis et al. 2009.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from functools import cache

import numpy as np

from clouds.generated import PAPER_PLANE_FIT_NEIGHBORS, Truth, generated
from harness.our_filters import run_filter
from harness.shared import CURVATURE, analytic_surfaces

POINTS = 2000
GRID_SIZE = {"torus": 1.0, "cylinder": 2.0}  # scale: the cylinder of the reference measurements has radius 1
AREAS = {"cylinder": 2.0 * np.pi, "torus": 1.6 * np.pi**2}


@cache
def grid_cloud(surface: str, percent: int, seed: int) -> tuple[Truth, np.ndarray]:
    """Cloud with its truth, and plane-fit normals; noise in percent of the median distance in minimum neighbourhoods."""
    clean = analytic_surfaces.generate(surface, POINTS, seed=seed)
    report = run_filter(CURVATURE, clean["positions"], clean["normals"], scale_mode="Paper").report
    noise = percent / 100.0 * report["median_spacing"] / analytic_surfaces.surface(surface).diagonal
    made, normals = generated(surface, POINTS, noise=noise, neighbors=PAPER_PLANE_FIT_NEIGHBORS, seed=seed)
    size = GRID_SIZE[surface]
    made.update(positions=size * made["positions"], k1=made["k1"] / size, k2=made["k2"] / size)
    return made, normals


def with_rim(surface: str, regular: bool, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An open cylinder, or the half of a torus: positions, exact normals (N x 3 each), distance to the rim in spacings."""
    made = analytic_surfaces.generate(surface, POINTS, seed=seed, regular=regular)
    positions, normals, distance = made["positions"], made["normals"], made["rim_distance"]
    if surface == "torus":
        angle = np.abs(np.arctan2(positions[:, 1], positions[:, 0]))
        kept = angle < 0.5 * np.pi
        rim = angle[kept].max() if regular else 0.5 * np.pi
        distance = ((rim - angle) * np.hypot(positions[:, 0], positions[:, 1]))[kept]
        positions, normals = positions[kept], normals[kept]
    return positions, normals, distance / np.sqrt(AREAS[surface] / POINTS)


def two_planes(seed: int, degrees: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of two half planes that meet at a right angle along y; their normals, disturbed and true (N x 3 each)."""
    random = np.random.default_rng(seed)
    along, across = random.uniform(-0.5, 0.5, POINTS), random.uniform(0.0, 0.5, POINTS)
    top = (np.arange(POINTS) % 2 == 0)[:, None]
    zero = np.zeros(POINTS)
    positions = np.where(top, np.column_stack([-across, along, zero]), np.column_stack([zero, along, -across]))
    true = np.where(top, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    normals = true + np.radians(degrees) * random.normal(size=true.shape)
    return positions, normals / np.linalg.norm(normals, axis=1, keepdims=True), true
