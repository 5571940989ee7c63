# Rows of the table of whole meshes: a Poisson surface, then quads by QuadriFlow or Instant Meshes, as many faces as ours.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from clouds.spacing import median_nearest_distance
from clouds.whole_shapes import Shape
from figures.mesh import PolygonMesh
from harness.comparison import Figures
from harness.report import progress
from peers.quad_routes import poisson_then_quads

DEPTH = 8  # of the octree
OURS, QUADRIFLOW = "ours", "QuadriFlow"
ROUTES = {QUADRIFLOW: "flow", "Instant Meshes": "instant_off", "Instant Meshes, 30°": "instant_30"}


def route(shape: Shape, method: str, faces: int) -> tuple[PolygonMesh | None, Figures]:
    """The mesh and the seconds it took; ``method``: a key of ROUTES."""
    # Random points are twice as far apart as from the nearest one.
    spacing = 2.0 * median_nearest_distance(shape.positions) if shape.is_open else 0.0
    try:
        made = poisson_then_quads(shape.positions, shape.normals, ROUTES[method], DEPTH, faces, spacing)
    except RuntimeError as failure:  # the others of this table are wanted nevertheless
        progress(str(failure).strip().splitlines()[-1])
        made = None
    return (None, {}) if made is None else (PolygonMesh(made.vertices, made.faces), {"seconds": made.seconds})
