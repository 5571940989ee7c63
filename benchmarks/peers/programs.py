# The peers' C++ programs from Python: builds them when first needed and runs them on a cloud.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

_SOURCE = Path(__file__).resolve().parent
BUILD = _SOURCE.parent.parent / "build" / "peers"
NO_POINTS = np.empty(0, dtype=np.int64)


@cache
def _built() -> Path:
    for command in (["cmake", "-S", _SOURCE, "-B", BUILD, "-DCMAKE_BUILD_TYPE=Release"], ["cmake", "--build", BUILD]):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"the peers do not build (libcgal-dev and libeigen3-dev are needed):\n{done.stderr}")
    return BUILD


def cgal_version() -> str:
    return subprocess.run(
        [_built() / "cgal_jets", "--version"], capture_output=True, text=True, check=True
    ).stdout.strip()


def write_cloud(path: Path, positions: np.ndarray, normals: np.ndarray, points: np.ndarray = NO_POINTS) -> None:
    """As cloud_file.h reads it."""
    with path.open("wb") as file:
        np.array([len(positions), len(points)], dtype=np.int64).tofile(file)
        np.hstack([positions, normals]).astype(np.float64).tofile(file)
        points.astype(np.int64).tofile(file)


def run_program(
    words: list[str], positions: np.ndarray, normals: np.ndarray, numbers: list[float], points: np.ndarray = NO_POINTS
) -> tuple[bytes, float]:
    """What a program (``words``: its name and what comes before the files) writes about a cloud, and says of its time."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, results = Path(folder) / "cloud.bin", Path(folder) / "results.bin"
        write_cloud(cloud, positions, normals, points)
        command = [str(_built() / words[0]), *words[1:], str(cloud), str(results), *map(str, numbers)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        return results.read_bytes(), float(done.stdout)
