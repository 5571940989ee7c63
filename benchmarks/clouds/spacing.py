# How far apart the points of a cloud are.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

SOME_POINTS = 500  # enough for a median


class NearestPoints:
    """Looks points up by VTK's search structure."""

    def __init__(self, points: np.ndarray) -> None:  # N x 3
        import pyvista
        from vtkmodules.vtkCommonDataModel import vtkStaticPointLocator

        self._points = np.ascontiguousarray(points)
        self._locator = vtkStaticPointLocator()
        self._locator.SetDataSet(pyvista.PolyData(self._points))
        self._locator.BuildLocator()

    def indices(self, places: np.ndarray, count: int) -> np.ndarray:
        """M x count: of the points nearest to some places (M x 3), in order of distance."""
        from vtkmodules.vtkCommonCore import vtkIdList

        if count == 1:
            return np.array([[self._locator.FindClosestPoint(place)] for place in places], dtype=int).reshape(-1, 1)
        found, nearest = vtkIdList(), np.empty((len(places), count), dtype=int)
        for index, place in enumerate(places):
            self._locator.FindClosestNPoints(count, place, found)
            nearest[index] = [found.GetId(rank) for rank in range(count)]
        length = np.linalg.norm(self._points[nearest] - places[:, None], axis=2)
        return np.take_along_axis(nearest, np.argsort(length, axis=1, kind="stable"), axis=1)

    def distances(self, places: np.ndarray, count: int) -> np.ndarray:
        """M x count: to the same points."""
        return np.linalg.norm(self._points[self.indices(places, count)] - places[:, None], axis=2)


def nearest_neighbor_distances(points: np.ndarray) -> np.ndarray:
    """Of every point (N x 3) to the nearest other one."""
    return NearestPoints(points).distances(points, 2)[:, 1]


def median_nearest_distance(positions: np.ndarray) -> float:
    """Over some of the points (N x 3)."""
    some = positions[:: max(1, len(positions) // SOME_POINTS)]
    return float(np.median([np.partition(np.linalg.norm(positions - p, axis=1), 1)[1] for p in some]))
