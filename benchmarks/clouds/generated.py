# Clouds of the exact surfaces in sample_data/ with normals as a scan would come with.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from harness.shared import analytic_surfaces

PLANE_FIT_NEIGHBORS = 16
PAPER_PLANE_FIT_NEIGHBORS = 25  # of our reference measurements of the published method

Truth = dict[str, np.ndarray]  # as analytic_surfaces.generate returns it: a row per point


def generated(
    surface: str, points: int, *, noise: float = 0.0, neighbors: int = PLANE_FIT_NEIGHBORS, **options
) -> tuple[Truth, np.ndarray]:
    """A cloud with its truth, and normals (N x 3) of planes fitted to the noisy points, their side the true one.

    noise: standard deviation per coordinate, a fraction of the surface's diagonal. Options: of analytic_surfaces.generate.
    """
    made = analytic_surfaces.generate(surface, points, noise=noise, **options)
    return made, analytic_surfaces.plane_fit_normals(made["positions"], made["normals"], neighbors)


def oriented(surface: str, points: int, noise: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions and plane-fit normals alone (N x 3 each)."""
    made, normals = generated(surface, points, noise=noise, seed=seed)
    return made["positions"], normals


def with_random_normals(normals: np.ndarray, share: float, seed: int) -> np.ndarray:
    """The normals (N x 3, unit) with about that share of them replaced by random ones."""
    random = np.random.default_rng(seed)
    wrong = random.random(len(normals)) < share
    disturbed = normals.copy()
    disturbed[wrong] = random.normal(size=(wrong.sum(), 3))
    return disturbed / np.linalg.norm(disturbed, axis=1, keepdims=True)
