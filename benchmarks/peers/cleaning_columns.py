# Columns of the table of cleaning: PyMeshLab, CGAL and Open3D, at their usual and at their best settings.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from clouds.cleaning import Cloud
from harness.comparison import Column, Method, one
from harness.results import Moved, Selection
from peers.cgal_cleaning import bilateral_smoothing, jet_smoothing, removed_outliers
from peers.meshlab_cleaning import apss_projection, local_outlier_probabilities
from peers.open3d_outliers import open3d_version, radius_outliers, statistical_outliers

NEIGHBORS_OF_LOOP = 32
NEIGHBORS_OF_REMOVAL = 24
CRASHING = "APSS, as it comes"  # never timed


def loop_at(probability: float) -> Method:
    return lambda cloud: local_outlier_probabilities(cloud.positions, probability, NEIGHBORS_OF_LOOP)


def statistical_at(neighbors: int, deviations: float) -> Method:
    return lambda cloud: statistical_outliers(cloud.positions, neighbors, deviations)


def radius_at(neighbors: int, spacings: float) -> Method:
    return lambda cloud: radius_outliers(cloud.positions, neighbors, spacings * cloud.spacing)


def true_share_removed(cloud: Cloud) -> Selection:
    return removed_outliers(cloud.positions, cloud.normals, NEIGHBORS_OF_REMOVAL, 100.0 * float(cloud.outlier.mean()))


def selecting_columns() -> list[Column]:
    columns = [
        one("LoOP, default", loop_at(0.8)),
        one("LoOP, 0.5", loop_at(0.5)),
        one("CGAL remove_outliers, true share", true_share_removed),
    ]
    if open3d_version() is None:
        return columns
    return [
        *columns,
        one("Open3D statistical 20, 2", statistical_at(20, 2.0)),
        Column(
            "best of Open3D statistical",
            {f"Open3D statistical {k}, {d:g}": statistical_at(k, d) for k, d in ((20, 2.0), (20, 0.5), (30, 1.0))},
        ),
        one("Open3D radius 16, 3.5 h", radius_at(16, 3.5)),
    ]


def apss_at(scale: float, smooth_normals: bool = False) -> Method:
    return lambda cloud: apss_projection(
        cloud.positions, cloud.smooth_normals if smooth_normals else cloud.normals, scale
    )


def apss_in_one_layer(cloud: Cloud) -> Moved | None:
    return apss_projection(cloud.positions, cloud.normals, 2, one_layer=True)


def jet_at(neighbors: int) -> Method:
    return lambda cloud: jet_smoothing(cloud.positions, cloud.normals, neighbors)


def bilateral_at(neighbors: int, degrees: float, iterations: int, smooth_normals: bool = False) -> Method:
    return lambda cloud: bilateral_smoothing(
        cloud.positions, cloud.smooth_normals if smooth_normals else cloud.normals, neighbors, degrees, iterations
    )


def moving_columns() -> list[Column]:
    return [
        one(CRASHING, apss_in_one_layer),
        one("APSS 2", apss_at(2)),
        Column("best APSS", {"APSS 2": apss_at(2)} | {f"APSS {s}": apss_at(s, smooth_normals=True) for s in (4, 12)}),
        one("CGAL jet 24", jet_at(24)),
        Column("best CGAL jet", {f"CGAL jet {k}": jet_at(k) for k in (24, 50, 100, 400, 800)}),
        one("CGAL bilateral 24, 30°, 1", bilateral_at(24, 30.0, 1)),
        Column(
            "best CGAL bilateral",
            {
                "CGAL bilateral 24, 30°, 1": bilateral_at(24, 30.0, 1),
                "CGAL bilateral 100, 30°, 1": bilateral_at(100, 30.0, 1, smooth_normals=True),
                "CGAL bilateral 100, 15°, 3": bilateral_at(100, 15.0, 3, smooth_normals=True),
            },
        ),
    ]
