# What every method of the curvature benchmark gives back, ours and the peers'.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Estimate:
    """Principal curvatures at some points of a cloud: convex positive, k1 >= k2; 0 where there is no estimate."""

    points: np.ndarray  # indices into the cloud
    k1: np.ndarray
    k2: np.ndarray
    d1: np.ndarray  # unit, or zero where there is no estimate
    normals: np.ndarray | None  # of the fitted surface, where the method has them
    seconds_per_point: float  # wall clock


def tidy(points, k1, k2, d1, d2, normals, seconds_per_point) -> Estimate:
    """An estimate in our conventions from one whose order is another and whose numbers may not be finite."""
    swapped = (k1 < k2)[:, None]
    largest, smallest = np.maximum(k1, k2), np.minimum(k1, k2)
    direction = np.where(swapped, d2, d1)
    length = np.linalg.norm(direction, axis=1, keepdims=True)
    direction = direction / np.where(length > 0.0, length, 1.0)
    finite = np.isfinite(k1) & np.isfinite(k2) & np.isfinite(direction).all(axis=1)
    return Estimate(
        points,
        np.where(finite, largest, 0.0),
        np.where(finite, smallest, 0.0),
        np.where(finite[:, None], direction, 0.0),
        normals,
        seconds_per_point,
    )
