# CGAL's jets as a peer of our curvature.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from harness.results import Estimate
from peers.estimate import tidy
from peers.programs import run_program


def jets(positions: np.ndarray, outward: np.ndarray, points: np.ndarray, degree: int, neighbors: int) -> Estimate:
    """Jets on the nearest neighbours of the ``points`` (indices); ``outward`` only says which side is outside."""
    written, seconds_per_point = run_program(["cgal_jets"], positions, outward, [degree, neighbors], points)
    rows = np.frombuffer(written).reshape(-1, 8)
    d1, normals = rows[:, 2:5], rows[:, 5:8]
    return tidy(points, rows[:, 0], rows[:, 1], d1, np.cross(normals, d1), normals, seconds_per_point)
