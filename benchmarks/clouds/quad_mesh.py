# The clouds of the table of quad meshes: exact surfaces and scans, and how many vertices a mesh of them is asked for.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from clouds.generated import oriented
from clouds.scans import oriented_vertices
from harness.shared import analytic_surfaces

TARGET_VERTICES = 1600  # of 20 000 points and more
OPEN_AREAS = {"helicoid": 2.96 * np.pi, "cylinder": 2.0 * np.pi, "half_torus": 0.8 * np.pi**2}


@dataclass(frozen=True)
class Cloud:
    surface: str  # the exact one; none of a scan
    positions: np.ndarray  # N x 3
    normals: np.ndarray  # N x 3
    target: int  # vertices; 0: the filter's own choice

    @property
    def spacing(self) -> float:
        """Root of the area per point, which the peers need of an open surface; 0 of a closed one."""
        if analytic_surfaces.surface(self.surface).closed:
            return 0.0
        return float(np.sqrt(OPEN_AREAS[self.surface] / len(self.positions)))


def sampled(surface: str, points: int, noise: float = 0.0) -> Callable[[int], Cloud]:
    def make(seed: int) -> Cloud:
        positions, normals = oriented(surface, points, noise, seed)
        return Cloud(surface, positions, normals, TARGET_VERTICES if points >= 20000 else 0)

    return make


@dataclass(frozen=True)
class Scan:
    """A file in the data folder."""

    file: str
    target: int  # vertices
    truth: str = ""  # the file with the faces to be compared with, if another one


SCANS = [
    Scan("cow_loop2_46433_derived.ply", 3000),
    Scan("bunny_oriented.ply", 3000),
    Scan("armadillo.obj", 3000),
    Scan("hand_closed.obj", 1000),
    Scan("fandisk_noise0.3.obj", 1000, "fandisk_clean.obj"),
    Scan("angel_rawscan.obj", 1500),
    Scan("tooth_pongo_DE.ply", 1000),
    Scan("tooth_pongo_EM.ply", 1000),
    Scan("meshlab_lato270_rawscan.ply", 3000),
]


def scanned(scan: Scan, data: Path) -> Cloud:
    positions, normals = oriented_vertices(data / scan.file)
    return Cloud("", positions, normals, scan.target)
