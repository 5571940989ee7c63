# Open3D's outlier filters, in an environment of their own under build/peers: .venv stays as scripts/setup.sh makes it.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import sys
import time
from functools import cache

import numpy as np

from harness.results import Selection
from peers.child_process import Arrays, in_child, serve
from peers.programs import BUILD

_ENVIRONMENT = BUILD / "open3d"
_PYTHON = _ENVIRONMENT / "bin" / "python"


@cache
def open3d_version() -> str | None:
    """Makes the environment if need be; None where Open3D cannot be had or does not load."""
    print_version = [_PYTHON, "-c", "import open3d; print(open3d.__version__)"]
    if not _PYTHON.exists():
        print("installing Open3D into build/peers (some 450 MB)", file=sys.stderr)
        subprocess.run([sys.executable, "-m", "venv", _ENVIRONMENT], check=True)
        subprocess.run([_PYTHON, "-m", "pip", "install", "-q", "open3d"], capture_output=True, check=False)
    done = subprocess.run(print_version, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def statistical_outliers(positions: np.ndarray, neighbors: int, deviations: float) -> Selection | None:
    return _selection(positions, "statistical", neighbors, deviations)


def radius_outliers(positions: np.ndarray, neighbors: int, radius: float) -> Selection | None:
    return _selection(positions, "radius", neighbors, radius)


def _selection(positions: np.ndarray, method: str, neighbors: int, number: float) -> Selection | None:
    if open3d_version() is None:
        return None
    found = in_child("peers.open3d_outliers", {"positions": positions}, method, neighbors, number, python=_PYTHON)
    return None if found is None else Selection(found["outliers"], float(found["seconds"]))


def _child(cloud: Arrays, method: str, neighbors: str, number: str) -> Arrays:
    import open3d

    points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cloud["positions"]))
    remove = points.remove_statistical_outlier if method == "statistical" else points.remove_radius_outlier
    start = time.perf_counter()
    _, kept = remove(int(neighbors), float(number))
    seconds = time.perf_counter() - start
    outliers = np.ones(len(cloud["positions"]), bool)
    outliers[np.asarray(kept, dtype=int)] = False
    return {"outliers": outliers, "seconds": np.array(seconds)}


if __name__ == "__main__":
    serve(_child)
