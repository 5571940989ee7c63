# The clouds of the table of curvature, and the truth at their foot points.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from clouds.generated import PLANE_FIT_NEIGHBORS, Truth, generated, with_random_normals
from harness.shared import analytic_surfaces

RIM_MARGIN = 0.2  # unit of the surface: nearer points are not judged


@dataclass(frozen=True)
class Cloud:
    """What the methods get (N x 3 each), the truth at the foot points, and the parts the figures are of."""

    positions: np.ndarray
    normals: np.ndarray
    truth: Truth
    parts: dict[str, np.ndarray]  # name: mask of points

    @staticmethod
    def whole(positions: np.ndarray, normals: np.ndarray, truth: Truth, mask: np.ndarray | None = None) -> Cloud:
        return Cloud(positions, normals, truth, {"": np.ones(len(positions), bool) if mask is None else mask})


def sampled(surface: str, points: int, noise: float = 0.0, outliers: float = 0.0) -> Callable[[int], Cloud]:
    """Clouds with plane-fit normals; away from rims, and without the outliers in what is judged."""

    def make(seed: int) -> Cloud:
        made, normals = generated(surface, points, noise=noise, outliers=outliers, seed=seed)
        judged = (made["rim_distance"] > RIM_MARGIN) & (made["label"] == analytic_surfaces.INLIER)
        return Cloud.whole(made["positions"], normals, made, judged)

    return make


def two_tori(points: int, small_share: float) -> Callable[[int], Cloud]:
    """Tori of size 1 and 1/5 beside each other, the same noise on both; a share of the points is the small one's."""
    small_size, offset = 0.2, np.array([2.0, 0.0, 0.0])
    sigma = 0.0025 * analytic_surfaces.surface("torus").diagonal

    def make(seed: int) -> Cloud:
        small = round(small_share * points)
        sizes = np.repeat([1.0, small_size], [points - small, small])
        centers = np.where((sizes < 1.0)[:, None], offset, 0.0)
        unit = [
            analytic_surfaces.generate("torus", count, seed=100 * which + seed)["positions"]
            for which, count in enumerate((points - small, small))
        ]
        positions = np.vstack(unit) * sizes[:, None] + centers
        positions += np.random.default_rng(seed).normal(scale=sigma, size=positions.shape)
        truth = analytic_surfaces.project("torus", (positions - centers) / sizes[:, None])
        truth["k1"], truth["k2"] = truth["k1"] / sizes, truth["k2"] / sizes
        normals = analytic_surfaces.plane_fit_normals(positions, truth["normals"], PLANE_FIT_NEIGHBORS)
        return Cloud(positions, normals, truth, {"large": sizes == 1.0, "small": sizes < 1.0})

    return make


def wrong_normals(points: int, share: float) -> Callable[[int], Cloud]:
    """A torus with exact normals but for a share of random ones."""

    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate("torus", points, seed=seed)
        return Cloud.whole(made["positions"], with_random_normals(made["normals"], share, seed), made)

    return make


def beside_edges(points: int, noise: float) -> Callable[[int], Cloud]:
    """A cube of side 1; judged are points whose foot point is 0.5 to 1.5 spacings from an edge."""
    spacing = np.sqrt(6.0 / points)

    def make(seed: int) -> Cloud:
        made, normals = generated("cube", points, noise=noise, seed=seed)
        distance = made["feature_distance"] / spacing
        return Cloud.whole(made["positions"], normals, made, (distance > 0.5) & (distance < 1.5))

    return make
