# A peer's curvature in the conventions of harness/results.py.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from harness.results import Estimate


def tidy(
    points: np.ndarray,
    k1: np.ndarray,
    k2: np.ndarray,
    d1: np.ndarray,
    d2: np.ndarray,
    normals: np.ndarray | None,
    seconds_per_point: float,
) -> Estimate:
    """From principal curvatures (M each) and directions (M x 3 each) in any order, which may not be finite."""
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
