# Curvature-driven surfaces (Tejada et al. 2006, "Curvature-driven modeling and rendering of point-based surfaces") as
# numbers: their weights, their projection, and the speed of their ray tracing beside moving least squares.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/ray_tracing.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from statistics import median

import numpy as np
import pymeshlab

import measures
from comparison import number
from measures import analytic_surfaces
from peers.programs import write_cloud

CURVATURE = "compute_curvature_m_weighted_per_vertex"
PROJECT = "compute_curvature_driven_projection"
DENOISE = "apply_coord_point_cloud_robust_denoising"
RAY_TRACE = "save_ray_traced_point_set_image"
SHAPES = {"fandisk": "fandisk_clean.obj", "bunny": "bunny_oriented.ply", "dragon": "dragon_vrip.ply"}
WIDTH, HEIGHT = 533, 400
PLANE_FIT_NEIGHBORS = 25
TORUS_AREA = 1.6 * np.pi**2
BUILD = measures.CHECKOUT / "build" / "release"


@dataclass(frozen=True)
class Settings:
    data: Path | None = None
    runs: int = 5
    seeds: range = range(1, 6)


def met(condition: bool) -> str:
    return "yes" if condition else "**no**"


def bounded(label: str, value: float, relation: str, bound: float) -> list[str]:
    holds = value <= bound if relation == "≤" else value >= bound
    return [label, number(value), f"{relation} {number(bound)}", met(holds)]


def figures(rows: list[list[str]]) -> str:
    return measures.markdown_table(["figure", "value", "must", "met"], rows)


@cache
def program() -> Path:
    """Of the checkout's own build, which scripts/setup.sh configures."""
    command = ["cmake", "--build", str(BUILD), "--target", "point_set_surfaces"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"point_set_surfaces does not build in build/release:\n{done.stdout}{done.stderr}")
    return BUILD / "benchmarks" / "point_set_surfaces"


def output_of(*words: str | Path) -> str:
    return subprocess.run([program(), *map(str, words)], capture_output=True, text=True, check=True).stdout


def weights(settings: Settings) -> str:
    rows = []
    for h, exponent in ((2.0, 1), (1.0, 1), (1.0, 2)):
        error = abs(float(output_of("peak", f"{h:g}", str(exponent))) - h * np.sqrt(exponent))
        rows.append(bounded(f"h = {h:g}, ξ = {exponent}: largest weight off h √ξ by", error, "≤", 1e-9))
    return "The functions of their figure 4.\n\n" + figures(rows)


def curvature_errors(seed: int) -> dict[str, float]:
    made = analytic_surfaces.generate("torus", 2000, noise=0.0025, seed=seed)
    errors = {}
    for weighting in ("M", "Unweighted", "Gaussian"):
        meshes = measures.layer(made["positions"], made["normals"])
        meshes.apply_filter(CURVATURE, weighting=weighting)
        errors[weighting] = measures.rms(
            meshes.current_mesh().vertex_custom_scalar_attribute_array("curv_k1") - made["k1"]
        )
    return errors


def weighting(settings: Settings) -> str:
    runs = [curvature_errors(seed) for seed in settings.seeds]
    m, plain, gaussian = (median(run[name] for run in runs) for name in ("M", "Unweighted", "Gaussian"))
    return (
        "What their figure 6 shows: RMS error of k1 on a torus (k1 = 2.5) of 2000 points with 0.25 % noise and exact "
        "normals, medians.\n\n"
        + measures.markdown_table(["weights", "RMS of k1"], [["M", number(m)], ["none", number(plain)], ["Gaussian", number(gaussian)]])
        + "\n"
        + figures([bounded("M / none", m / plain, "≤", 0.5), bounded("M / Gaussian", m / gaussian, "≤", 0.2)])
    )


def projected(positions: np.ndarray, normals: np.ndarray, proxy: np.ndarray, **parameters) -> np.ndarray:
    meshes = measures.layer(positions, normals)
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=proxy))
    meshes.apply_filter(PROJECT, control_mesh=0, proxy_mesh=1, **parameters)
    return meshes.mesh(1).vertex_matrix()


def off_torus(positions: np.ndarray) -> float:
    return measures.rms(measures.distance_to_surface("torus", positions))


def denoised(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    meshes = measures.layer(positions, normals)
    meshes.apply_filter(DENOISE)
    return meshes.current_mesh().vertex_matrix()


def least_squares(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """On the moving-least-squares surface that the ray tracer compares with; in another order."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, moved = Path(folder) / "cloud.bin", Path(folder) / "moved.bin"
        write_cloud(cloud, positions, normals)
        output_of("project", cloud, moved)
        return np.fromfile(moved).reshape(-1, 3)


def projection(settings: Settings) -> str:
    points, judged = 20000, 4000
    spacing = np.sqrt(TORUS_AREA / points)
    off, again, ratios = [], [], {name: [] for name in ("Hermite", "Cutoff", "Rational", "squares", "denoising")}
    for seed in settings.seeds:
        print(f"projection, seed {seed}", file=sys.stderr)
        made = analytic_surfaces.generate("torus", points, seed=seed)
        scatter = np.random.default_rng(seed).normal(scale=0.3 * spacing, size=(judged, 3))
        once = projected(made["positions"], made["normals"], made["positions"][:judged] + scatter)
        twice = projected(made["positions"], made["normals"], once)
        off.append(off_torus(once) / spacing)
        again.append(measures.rms(np.linalg.norm(twice - once, axis=1)) / spacing)

        noisy = analytic_surfaces.generate("torus", points, noise=0.005, seed=seed)
        normals = analytic_surfaces.plane_fit_normals(noisy["positions"], noisy["normals"], PLANE_FIT_NEIGHBORS)
        before = off_torus(noisy["positions"])
        for name in ("Hermite", "Cutoff", "Rational"):
            moved = projected(noisy["positions"], normals, noisy["positions"], diffusion_function=name)
            ratios[name].append(off_torus(moved) / before)
        ratios["squares"].append(off_torus(least_squares(noisy["positions"], normals)) / before)
        ratios["denoising"].append(off_torus(denoised(noisy["positions"], normals)) / before)
    rows = [
        bounded("clean: RMS distance to the surface, spacings", median(off), "≤", 0.01),
        bounded("clean: P(P(r)) − P(r), RMS, spacings", median(again), "≤", 1e-3),
        bounded("0.5 % noise: RMS after / before, defaults (Hermite)", median(ratios["Hermite"]), "≤", 0.35),
        *(
            [f"the same, {name} (as published)", number(median(ratios[name])), "–", ""]
            for name in ("Cutoff", "Rational")
        ),
        ["the same by moving least squares, as traced below", number(median(ratios["squares"])), "–", ""],
        ["the same by *Denoise Point Cloud by Robust Curvature*, whose scale adapts", number(median(ratios["denoising"])), "–", ""],
    ]
    return (
        f"Torus of {points} points; spacing: root of the area per point. Clean: {judged} of the points displaced by 0.3 "
        f"spacings per axis. Noisy: all points, normals are planes fitted to {PLANE_FIT_NEIGHBORS} neighbours. Medians.\n\n"
        + figures(rows)
    )


def compared(name: str, settings: Settings) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        cloud = Path(folder) / "cloud.bin"
        write_cloud(cloud, *shape(name, settings))
        return json.loads(output_of("compare", cloud, WIDTH, HEIGHT, settings.runs))


def shape(name: str, settings: Settings) -> tuple[np.ndarray, np.ndarray]:
    assert settings.data is not None
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(settings.data / SHAPES[name]))
    if meshes.current_mesh().face_number() > 0:
        meshes.meshing_remove_unreferenced_vertices()
        meshes.compute_normal_per_vertex()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().vertex_normal_matrix()


def images(settings: Settings) -> str:
    if settings.data is None:
        return "Left out: run with `--data FOLDER`.\n"
    rows = []
    for name in SHAPES:
        print(f"images of {name}", file=sys.stderr)
        found = compared(name, settings)
        driven, squares = median(found["driven"]), median(found["squares"])
        ratio, agreement, depth = squares / driven, 100.0 * found["agreement"], found["depth_difference"]
        row = [name, f"{driven:.3f}", f"{squares:.3f}", f"{ratio:.2f}", met(ratio >= 1.5)]
        rows.append([*row, f"{agreement:.2f}", met(agreement >= 99.5), f"{depth:.3f}", met(depth < 0.2)])
    header = ["shape", "curvature-driven, s", "moving least squares, s", "ratio", "≥ 1.5"]
    header += ["pixels that agree, %", "≥ 99.5", "mean depth difference, spacings", "< 0.2"]
    return (
        f"Their figure 7 and their claim, 1.5 to 2.5 times faster than moving least squares: rays of {WIDTH} × {HEIGHT} "
        f"pixels, both surfaces in one process on the same neighbourhoods, medians of {settings.runs} runs each, each first "
        "half of the time. Other work may have run on the machine: trust the ratios more than the seconds. Preparation "
        "(neighbourhoods, spheres), the same for both, is not in them; colours and the smoothing of outlines neither. The "
        "bandwidths are those that leave about as much noise (see Projection): 1.6 spacings here, 2 of moving least squares, "
        "whose complete quadratics need more points for it.\n\n"
        + measures.markdown_table(header, rows)
        + "\nBoth surfaces share what finds and gathers the points around a ray. Where a point covers many pixels that is "
        "done once for many rays, and what is left differs; of the dragon, whose points are as dense as the pixels, nearly "
        "every ray meets a point of its own, and gathering its neighbours is most of the work of both.\n"
    )


def whole_filter(settings: Settings) -> str:
    if settings.data is None:
        return "Left out: run with `--data FOLDER`.\n"
    rows = []
    for name in SHAPES:
        for surface in ("Curvature-Driven", "Moving Least Squares"):
            print(f"filter on {name}, {surface}", file=sys.stderr)
            meshes = measures.layer(*shape(name, settings))
            with tempfile.TemporaryDirectory() as folder:
                start = time.perf_counter()
                report = meshes.apply_filter(RAY_TRACE, image_file=str(Path(folder) / "image.png"), surface=surface)
                seconds = time.perf_counter() - start
            row = [name, str(report["points"]), surface, f"{report['seconds_preparation']:.2f}"]
            row += [f"{report['seconds_rendering']:.2f}", f"{seconds:.2f}", met(seconds < 60.0) if name == "dragon" else ""]
            rows.append(row)
    header = ["shape", "points", "surface", "preparation, s", "rendering, s", "whole filter, s", "< 60 s"]
    return f"The filter with its defaults, {WIDTH} × {HEIGHT}, PNG written, one run.\n\n" + measures.markdown_table(header, rows)


EXPERIMENTS: dict[str, tuple[str, Callable[[Settings], str]]] = {
    "weights": ("M weights", weights),
    "weighting": ("Curvature by weights", weighting),
    "projection": ("Projection", projection),
    "images": ("Ray tracing of both surfaces", images),
    "filter": ("Pictures from start to end", whole_filter),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help=", ".join(EXPERIMENTS))
    parser.add_argument("--data", type=Path, metavar="FOLDER", help=f"where {', '.join(SHAPES.values())} are")
    given = parser.parse_args()
    for name in given.experiments:
        if name not in EXPERIMENTS:
            parser.error(f"no experiment is called {name}")
    settings = Settings(data=given.data)
    sections = []
    for title, run in (EXPERIMENTS[name] for name in given.experiments or EXPERIMENTS):
        sections.append(f"## {title}\n\n{run(settings)}")
        if given.experiments:
            print(sections[-1], flush=True)
    if not given.experiments:
        command = "ray_tracing.py" + (" --data FOLDER" if given.data else "")
        measures.write_result("ray_tracing", command, "Curvature-driven surfaces", "\n".join(sections))


if __name__ == "__main__":
    main()
