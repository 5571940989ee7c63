# CGAL's filters of point sets as peers of our cleaning.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from harness.results import Moved, Selection
from peers.programs import run_program


def _moved(method: str, positions: np.ndarray, normals: np.ndarray, numbers: list[float]) -> Moved:
    written, seconds = run_program(["cgal_cleaning", method], positions, normals, numbers)
    return Moved(np.frombuffer(written).reshape(-1, 3), seconds)


def jet_smoothing(positions: np.ndarray, normals: np.ndarray, neighbors: int) -> Moved:
    return _moved("jet", positions, normals, [neighbors])


def bilateral_smoothing(
    positions: np.ndarray, normals: np.ndarray, neighbors: int, degrees: float, iterations: int
) -> Moved:
    return _moved("bilateral", positions, normals, [neighbors, degrees, iterations])


def removed_outliers(positions: np.ndarray, normals: np.ndarray, neighbors: int, percent: float) -> Selection:
    """This filter removes the given share, whatever the cloud is like."""
    written, seconds = run_program(["cgal_cleaning", "outliers"], positions, normals, [neighbors, percent])
    outliers = np.zeros(len(positions), bool)
    outliers[np.frombuffer(written, dtype=np.int64)] = True
    return Selection(outliers, seconds)
