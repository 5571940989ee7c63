# Columns of the table of curvature: CGAL's jets and PyMeshLab's algebraic point-set surfaces, each at its usual and at
# its best setting.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from clouds.curvature import Cloud
from harness.comparison import Column, Method, one
from peers.apss import DEFAULT_SCALE, apss
from peers.jets import jets

JET_POINTS = 2000  # at which jets are evaluated: enough for an RMS
JET_USUAL = (2, 50)  # degree, neighbours
JET_SETTINGS = [(degree, neighbors) for degree in (2, 4) for neighbors in (20, 50, 200, 400)]
APSS_SCALES = (DEFAULT_SCALE, 12)


def some_points(cloud: Cloud) -> np.ndarray:
    """Indices: of every part as many as its figures need, the same in every run."""
    chosen = np.random.default_rng(0)
    parts = [np.flatnonzero(mask) for mask in cloud.parts.values()]
    return np.concatenate([chosen.choice(part, min(len(part), JET_POINTS), replace=False) for part in parts])


def jets_on(degree: int, neighbors: int) -> Method:
    return lambda cloud: jets(cloud.positions, cloud.truth["normals"], some_points(cloud), degree, neighbors)


def apss_at(scale: float) -> Method:
    return lambda cloud: apss(cloud.positions, cloud.normals, scale)


def setting_name(degree: int, neighbors: int) -> str:
    return f"{degree}, {neighbors}"


def curvature_columns() -> list[Column]:
    all_jets = {setting_name(*setting): jets_on(*setting) for setting in JET_SETTINGS}
    usual = setting_name(*JET_USUAL)
    return [
        Column(f"CGAL jet, degree {JET_USUAL[0]}, k = {JET_USUAL[1]}", {usual: all_jets[usual]}),
        Column("best CGAL jet (degree, k)", all_jets),
        *(one(f"PyMeshLab APSS, filterscale {scale}", apss_at(scale)) for scale in APSS_SCALES),
    ]
