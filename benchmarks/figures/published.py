# What the figures of Kalogerakis et al. 2009 show beyond curvature errors: hues, residuals of pairs, and the published fit
# without its robustness.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from clouds.generated import Truth

HUE_TOLERANCE = np.radians(30.0)  # half the way to the next colour that has a name of its own


def hue_of_colors(colors: np.ndarray) -> np.ndarray:
    """Radians, of rows of red, green, blue."""
    red, green, blue = colors[:, :3].T
    return np.arctan2(np.sqrt(3.0) * (green - blue), 2.0 * red - green - blue)


def hue_of_curvature(k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """Radians (Rusinkiewicz 2004): convex red, saddle green, concave blue."""
    mean, gaussian = 0.5 * (k1 + k2), k1 * k2
    return 4.0 / 3.0 * np.abs(np.arctan2(mean**2 - gaussian, mean * np.abs(mean)))


def right_hues(colors: np.ndarray, truth: Truth) -> np.ndarray:
    """Mask of the points whose colour is that of the true curvature."""
    turn = hue_of_colors(colors) - hue_of_curvature(truth["k1"], truth["k2"])
    return np.abs((turn + np.pi) % (2.0 * np.pi) - np.pi) < HUE_TOLERANCE


def pair_residuals(positions: np.ndarray, normals: np.ndarray, frame: np.ndarray, tensor: np.ndarray) -> np.ndarray:
    """Norms of X dp - dn over all pairs of points (N x 3 each); X = `tensor` (3 x 2) in the `frame` (u, v, w as rows)."""
    a, b = np.triu_indices(len(positions), 1)
    moves, turns = (positions[b] - positions[a]) @ frame.T, (normals[b] - normals[a]) @ frame.T
    return np.linalg.norm(moves[:, :2] @ tensor.T - turns, axis=1)


def residuals_around(made: Truth, center: int, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Of all pairs of points within the radius: mean distance to the center, residual against the exact tensor there."""
    length = np.linalg.norm(made["positions"] - made["positions"][center], axis=1)
    region = np.flatnonzero(length < radius)
    frame = np.array([made["d1"][center], made["d2"][center], made["normals"][center]])
    tensor = np.array([[made["k1"][center], 0.0], [0.0, made["k2"][center]], [0.0, 0.0]])
    a, b = np.triu_indices(len(region), 1)
    residuals = pair_residuals(made["positions"][region], made["normals"][region], frame, tensor)
    return 0.5 * (length[region[a]] + length[region[b]]), residuals


@dataclass(frozen=True)
class VarianceFit:
    """A quadratic in the mean distance, through the variance of the residuals."""

    determination: float  # R²
    leading: float  # coefficient of the square


def variance_fit(distance: np.ndarray, residual: np.ndarray, classes: int) -> VarianceFit:
    """Of pairs in classes of equal size by distance."""
    edges = np.quantile(distance, np.linspace(0.0, 1.0, classes + 1))
    which = np.clip(np.searchsorted(edges, distance, side="right") - 1, 0, classes - 1)
    middle = np.array([distance[which == number].mean() for number in range(classes)])
    variance = np.array([residual[which == number].var() for number in range(classes)])
    quadratic = np.polyfit(middle, variance, 2)
    left = variance - np.polyval(quadratic, middle)
    return VarianceFit(1.0 - left.var() / variance.var(), quadratic[0])


def least_squares_k1(positions: np.ndarray, normals: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """k1 of the published fit without its robustness: all pairs in the region, geometric weights alone."""
    k1 = np.empty(len(positions))
    for i, center in enumerate(positions):
        squared = np.sum((positions - center) ** 2, axis=1)
        region = np.flatnonzero(squared < radii[i] ** 2)
        helper = np.eye(3)[np.argmin(np.abs(normals[i]))]
        u = np.cross(normals[i], helper)
        u /= np.linalg.norm(u)
        plane = np.array([u, np.cross(normals[i], u)])
        a, b = (region[index] for index in np.triu_indices(len(region), 1))
        moves, turns = (positions[b] - positions[a]) @ plane.T, (normals[b] - normals[a]) @ plane.T
        weights = 2.0 / (squared[a] + squared[b])
        solution = np.linalg.lstsq(
            moves.T @ (weights[:, None] * moves), moves.T @ (weights[:, None] * turns), rcond=None
        )[0]
        k1[i] = np.linalg.eigvalsh(0.5 * (solution + solution.T))[1]
    return k1
