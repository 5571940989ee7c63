# Time and memory of one of our filters in a process of its own: the plugin remembers the estimates of clouds it has
# seen, and what the process held before would hide the peak.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import multiprocessing
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from harness.our_filters import run_on
from harness.process_memory import peak_megabytes, reset_peak
from harness.shared import layer

Result = TypeVar("Result")


def in_fresh_process(function: Callable[..., Result], *arguments: object) -> Result:
    """``function`` is one of a module; it, its arguments and its result are pickled."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=context) as pool:
        return pool.submit(function, *arguments).result()


@dataclass(frozen=True, order=True)
class Cost:
    wall: float  # microseconds per point
    processor: float  # microseconds per point, all threads
    megabytes: float  # at the peak, above the host with the cloud loaded


def _cost(cloud: str, filter_name: str, parameters: dict[str, object]) -> Cost:
    with np.load(cloud) as given:
        meshes = layer(given["positions"], given["normals"])
    points = meshes.current_mesh().vertex_number()
    reset_peak()
    loaded = peak_megabytes()
    ran = run_on(meshes, filter_name, **parameters)
    return Cost(1e6 * ran.seconds / points, 1e6 * ran.processor_seconds / points, peak_megabytes() - loaded)


def cost_of(filter_name: str, positions: np.ndarray, normals: np.ndarray, runs: int = 1, **parameters: object) -> Cost:
    """The fastest of some runs on a cloud (N x 3 each), each run in a new process."""
    with tempfile.TemporaryDirectory() as folder:
        cloud = Path(folder) / "cloud.npz"
        np.savez(cloud, positions=positions, normals=normals)
        return min(in_fresh_process(_cost, str(cloud), filter_name, parameters) for _ in range(runs))
