# CGAL's jets from Python: builds cgal_jets and runs it on a cloud.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from peers.estimate import Estimate, tidy

_SOURCE = Path(__file__).resolve().parent
_BUILD = _SOURCE.parent.parent / "build" / "peers"


@cache
def _program() -> Path:
    for command in (["cmake", "-S", _SOURCE, "-B", _BUILD, "-DCMAKE_BUILD_TYPE=Release"], ["cmake", "--build", _BUILD]):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"CGAL's jets do not build (libcgal-dev and libeigen3-dev are needed):\n{done.stderr}")
    return _BUILD / "cgal_jets"


def version() -> str:
    return subprocess.run([_program(), "--version"], capture_output=True, text=True, check=True).stdout.strip()


def jets(positions: np.ndarray, outward: np.ndarray, points: np.ndarray, degree: int, neighbors: int) -> Estimate:
    """Jets on the nearest neighbours of the ``points`` (indices); ``outward`` only says which side is outside."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, estimates = Path(folder) / "cloud.bin", Path(folder) / "estimates.bin"
        with cloud.open("wb") as file:
            np.array([len(positions), len(points)], dtype=np.int64).tofile(file)
            np.hstack([positions, outward]).astype(np.float64).tofile(file)
            points.astype(np.int64).tofile(file)
        done = subprocess.run(
            [_program(), cloud, estimates, str(degree), str(neighbors)], capture_output=True, text=True, check=True
        )
        rows = np.fromfile(estimates).reshape(-1, 8)
    d1, normals = rows[:, 2:5], rows[:, 5:8]
    return tidy(points, rows[:, 0], rows[:, 1], d1, np.cross(normals, d1), normals, float(done.stdout))
