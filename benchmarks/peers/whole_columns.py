# Rows of the table of whole meshes: a Poisson surface, then quads by QuadriFlow or Instant Meshes, as many faces as ours.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from clouds.whole_shapes import Shape
from figures.mesh import PolygonMesh, distances
from harness.comparison import Figures
from harness.report import progress
from harness.shared import rms
from peers.quad_routes import RouteMesh, poisson_then_quads

DEPTH = 8  # of the octree
OURS, QUADRIFLOW = "ours", "QuadriFlow"
ROUTES = {QUADRIFLOW: "flow", "Instant Meshes": "instant_off", "Instant Meshes, 30°": "instant_30"}
REQUESTS = 3  # of a peer that misses the number of faces it is asked for
CLOSE, NEAR = 0.03, 0.05  # to that number: no other request; still to be compared


def made_by(shape: Shape, method: str, faces: int) -> RouteMesh | None:
    spacing = shape.spacing if shape.is_open else 0.0
    try:
        return poisson_then_quads(shape.positions, shape.normals, ROUTES[method], DEPTH, faces, spacing, threads=1)
    except RuntimeError as failure:  # the others of the table are wanted nevertheless
        progress(str(failure).strip().splitlines()[-1])
        return None


def route(shape: Shape, method: str, faces: int) -> tuple[PolygonMesh | None, Figures]:
    """The mesh and the seconds it took; ``method``: a key of ROUTES.

    QuadriFlow makes up to an eighth less faces than it is asked for, and at some numbers cuts a limb off that it keeps at
    others: it is asked again, and of meshes near our number that to which the points are nearest is taken.
    """
    asked, tried = faces, []
    for _ in range(REQUESTS):
        made = made_by(shape, method, asked)
        if made is None:
            break
        mesh = PolygonMesh(made.vertices, made.faces)
        off = abs(len(mesh.faces) / faces - 1.0)
        missed = rms(distances(shape.truth, mesh.vertices, mesh.triangles))
        tried.append(((max(off, NEAR), missed), mesh, made.seconds))
        if off < CLOSE:
            break
        asked = round(asked * faces / len(mesh.faces))
    if not tried:
        return None, {}
    _, mesh, seconds = min(tried, key=lambda one: one[0])
    return mesh, {"seconds": seconds}
