# How far apart the points of a cloud are.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

SOME_POINTS = 500  # enough for a median


def nearest_neighbor_distances(points: np.ndarray) -> np.ndarray:
    """Of every point (N x 3) to the nearest other one, by VTK's search structure."""
    import pyvista
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkStaticPointLocator

    locator = vtkStaticPointLocator()
    locator.SetDataSet(pyvista.PolyData(points))
    locator.BuildLocator()
    found, nearest = vtkIdList(), np.empty(len(points))
    for index, point in enumerate(points):
        locator.FindClosestNPoints(2, point, found)
        nearest[index] = max(np.linalg.norm(points[found.GetId(place)] - point) for place in (0, 1))
    return nearest


def median_nearest_distance(positions: np.ndarray) -> float:
    """Over some of the points (N x 3)."""
    some = positions[:: max(1, len(positions) // SOME_POINTS)]
    return float(np.median([np.partition(np.linalg.norm(positions - p, axis=1), 1)[1] for p in some]))
