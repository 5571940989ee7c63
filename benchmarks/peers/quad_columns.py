# Columns of the table of quad meshes: Poisson surfaces at two depths, then quads by three tools.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import importlib.util
import sys

from clouds.quad_mesh import TARGET_VERTICES, Cloud
from figures.mesh import PolygonMesh
from harness.comparison import Column, Method, one
from peers.quad_routes import PACKAGES, QUADS, poisson_then_quads

DEPTHS = (8, 6)  # of the octree
SHOWN = ("Instant Meshes", "QuadriFlow")  # at the first depth, in columns of their own


def route(quads: str, depth: int) -> Method:
    def run(cloud: Cloud) -> PolygonMesh | None:
        faces = cloud.target or TARGET_VERTICES // 4
        found = poisson_then_quads(cloud.positions, cloud.normals, quads, depth, faces, cloud.spacing)
        return None if found is None else PolygonMesh(found.vertices, found.faces)

    return run


def check_packages() -> None:
    missing = [package for package in PACKAGES if importlib.util.find_spec(package) is None]
    if missing:
        sys.exit(f"the peers need packages: .venv/bin/python -m pip install {' '.join(missing)} (or --without-peers)")


def quad_columns() -> list[Column]:
    check_packages()
    routes = {f"Poisson {depth} + {name}": route(key, depth) for depth in DEPTHS for key, name in QUADS.items()}
    shown = (f"Poisson {DEPTHS[0]} + {name}" for name in SHOWN)
    return [*(one(title, routes[title]) for title in shown), Column("best of all", routes)]
