# Time and memory of one of our filters in a process of its own: the plugin remembers the estimates of clouds it has
# seen, and what the process held before would hide the peak.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import multiprocessing
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import measures
from process_memory import peak_megabytes, reset_peak


@dataclass(frozen=True, order=True)
class Cost:
    wall: float  # microseconds per point
    processor: float  # microseconds per point, all threads
    megabytes: float  # at the peak, above the host with the cloud loaded


def _cost(cloud: str, filter_name: str, parameters: dict[str, object]) -> Cost:
    with np.load(cloud) as given:
        meshes = measures.layer(given["positions"], given["normals"])
    points = meshes.current_mesh().vertex_number()
    reset_peak()
    loaded = peak_megabytes()
    wall, processor = time.perf_counter(), time.process_time()
    meshes.apply_filter(filter_name, **parameters)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    return Cost(1e6 * wall / points, 1e6 * processor / points, peak_megabytes() - loaded)


def cost_of(filter_name: str, positions: np.ndarray, normals: np.ndarray, parameters: dict[str, object] | None = None) -> Cost:
    context = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor(max_workers=1, mp_context=context) as pool:
        cloud = Path(folder) / "cloud.npz"
        np.savez(cloud, positions=positions, normals=normals)
        return pool.submit(_cost, str(cloud), filter_name, parameters or {}).result()
