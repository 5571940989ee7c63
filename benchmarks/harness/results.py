# What a method gives back, ours and the peers' alike.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Estimate:
    """Principal curvatures at some points of a cloud: convex positive, k1 >= k2; 0 where there is no estimate."""

    points: np.ndarray  # M indices into the cloud
    k1: np.ndarray  # M, per unit length
    k2: np.ndarray
    d1: np.ndarray  # M x 3, unit, or zero where there is no estimate
    normals: np.ndarray | None  # M x 3 of the fitted surface, where the method has them
    seconds_per_point: float  # wall clock


@dataclass(frozen=True)
class Selection:
    outliers: np.ndarray  # mask of the N points
    seconds: float  # wall clock


@dataclass(frozen=True)
class Moved:
    positions: np.ndarray  # N x 3, of all points, in the order given
    seconds: float  # wall clock
    report: dict[str, float] = field(default_factory=dict)  # what the filter says of it; peers say nothing
