# Seconds per stage and peak memory beside Table 1 of Kalogerakis et al. 2009 ("Extracting lines of curvature from
# noisy point clouds"): the published method on one core, each cloud in a process of its own.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/table1.md."""

from __future__ import annotations

import argparse
import multiprocessing
import os
import resource
import time
from concurrent.futures import ProcessPoolExecutor

# Before OpenMP starts, here and in the processes below.
os.environ["OMP_NUM_THREADS"] = "1"

import measures  # noqa: E402
from measures import analytic_surfaces  # noqa: E402

STAGES = ("curvature", "normals", "outliers", "denoising", "lines", "meshing")
PUBLISHED = {  # seconds of STAGES, total; megabytes: 3 GHz Pentium IV
    "torus 1600": ((0.7, 0.2, 0.1, 2.4, 2.9, 0.9), 7.2, 14.5),
    "cube 600": ((0.2, 0.1, 0.1, 1.3, 2.1, 0.5), 4.3, 10.0),
    "helicoid 1730": ((0.9, 0.3, 0.2, 3.3, 3.9, 1.1), 9.7, 22.1),
    "cow 46K": ((16.5, 5.7, 0.9, 43.5, 99.7, 34.6), 200.9, 240.3),
}
# The stages of our pipeline that do the work of a published one. Normals are corrected by the curvature fit itself.
PUBLISHED_STAGE_OF = {
    "neighborhoods": "curvature",
    "curvature": "curvature",
    "outliers": "outliers",
    "denoising": "denoising",
    "directions": "lines",
    "umbilics": "lines",
    "voronoi": "lines",
    "tracing": "lines",
    "mesh": "meshing",
}


def cloud(name: str):
    if name == "cow 46K":
        return measures.meshlab_sample("cow.obj", subdivisions=2)
    surface, points = name.split()
    noise = 0.0 if surface == "cube" else 0.005
    made = analytic_surfaces.generate(surface, int(points), noise=noise, seed=1)
    return made["positions"], made["normals"]


def peak_megabytes() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def run(name: str) -> tuple[int, dict[str, float], float, float, float]:
    """Points, seconds of each published stage, in all by the wall clock and of the processor, megabytes above idle."""
    positions, normals = cloud(name)
    meshes = measures.layer(positions, normals)
    idle = peak_megabytes()
    wall, processor = time.perf_counter(), time.process_time()
    values = meshes.generate_surface_reconstruction_curvature_aligned(method="Traced Lines", scale_mode="Paper")
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    seconds = dict.fromkeys(STAGES, 0.0)
    for key, value in values.items():
        if key.startswith("seconds_") and key != "seconds_total":
            seconds[PUBLISHED_STAGE_OF[key.removeprefix("seconds_")]] += value
    return len(positions), seconds, wall, processor, peak_megabytes() - idle


def in_own_process(name: str):
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=context) as pool:
        return pool.submit(run, name).result()


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    rows = []
    for name, (stages, total, memory) in PUBLISHED.items():
        rows.append([name, "published", *(f"{s:.1f}" for s in stages), f"{total:.1f}", "–", f"{memory:.0f}"])
        points, seconds, wall, processor, memory = in_own_process(name)
        cells = ["–" if stage == "normals" else f"{seconds[stage]:.2f}" for stage in STAGES]
        rows.append([f"{points} points", "ours", *cells, f"{wall:.2f}", f"{processor:.2f}", f"{memory:.0f}"])
    body = (
        "Seconds per stage. Published: Kalogerakis et al. 2009, Table 1, one 3 GHz Pentium IV. Ours: the same method "
        "(`Traced Lines`) on one thread, with robust outlier rejection and denoising, which need no curvature; it is "
        "estimated once, after them, and corrects the normals as it goes; smoothing of directions, umbilics and Voronoi cells count as extraction of lines. Where `processor` is well "
        "below `total`, the machine was busy with other work and all stages took that much less of it. Memory is the peak "
        "above that of the host with the cloud loaded. Clouds: torus and helicoid with 0.5 % noise, cube without, all "
        "with true normals; the cow is PyMeshLab's sample after two Loop subdivisions.\n\n"
        + measures.markdown_table(
            [
                "Cloud", "", "curvature", "normal correction", "outliers", "denoising", "lines", "meshing", "total",
                "processor", "MB",
            ],  # fmt: skip
            rows,
        )
    )
    measures.write_result("table1", "table1.py", "Time per stage", body)


if __name__ == "__main__":
    main()
