# Curvature-driven surfaces (Tejada et al. 2006, "Curvature-driven modeling and rendering of point-based surfaces") as
# numbers: their weights, their projection, and the speed of their ray tracing beside moving least squares.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from statistics import median

import numpy as np
import pymeshlab

from clouds.generated import PAPER_PLANE_FIT_NEIGHBORS, generated
from clouds.scans import oriented_vertices
from figures.surface import rms_distance
from harness.command_line import Benchmark, Settings, main
from harness.comparison import Figures, over_seeds
from harness.our_filters import run_filter, run_on
from harness.report import markdown_table, progress
from harness.shared import BUILD, DENOISE, M_WEIGHTED, PROJECT, RAY_TRACE, analytic_surfaces, layer, rms
from harness.verdicts import Bound, bound_cells, number, yes
from peers.programs import write_cloud

SHAPES = {"fandisk": "fandisk_clean.obj", "bunny": "bunny_oriented.ply", "dragon": "dragon_vrip.ply"}
WIDTH, HEIGHT = 533, 400
RUNS = 5  # of each surface, by turns
TORUS_AREA = 1.6 * np.pi**2
WEIGHTINGS = ("M", "Unweighted", "Gaussian")
DIFFUSIONS = ("Hermite", "Cutoff", "Rational")

BENCHMARK = Benchmark("ray_tracing", "Curvature-driven surfaces", data=f"{', '.join(SHAPES.values())} are")


def row(label: str, value: float, bound: Bound | None = None) -> list[str]:
    return [label, number(value), *bound_cells(bound, value)]


def table(rows: list[list[str]]) -> str:
    return markdown_table(["figure", "value", "must", "met"], rows)


@cache
def program() -> Path:
    """Of the checkout's own build, which scripts/setup.sh configures."""
    command = ["cmake", "--build", str(BUILD), "--target", "point_set_surfaces"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"point_set_surfaces does not build in build/release:\n{done.stdout}{done.stderr}")
    return BUILD / "benchmarks" / "point_set_surfaces"


def output_of(*words: object) -> str:
    return subprocess.run([program(), *map(str, words)], capture_output=True, text=True, check=True).stdout


@BENCHMARK.experiment("weights", "M weights")
def weights(_: Settings) -> str:
    rows = []
    for h, exponent in ((2.0, 1), (1.0, 1), (1.0, 2)):
        error = abs(float(output_of("peak", f"{h:g}", str(exponent))) - h * np.sqrt(exponent))
        rows.append(row(f"h = {h:g}, ξ = {exponent}: largest weight off h √ξ by", error, Bound(1e-9)))
    return "The functions of their figure 4.\n\n" + table(rows)


def curvature_errors(seed: int) -> Figures:
    made = analytic_surfaces.generate("torus", 2000, noise=0.0025, seed=seed)
    return {
        name: rms(
            run_filter(M_WEIGHTED, made["positions"], made["normals"], weighting=name).attribute("curv_k1") - made["k1"]
        )
        for name in WEIGHTINGS
    }


@BENCHMARK.experiment("weighting", "Curvature by weights")
def weighting(settings: Settings) -> str:
    outcome = over_seeds("weighting", settings.seeds, curvature_errors)
    m, plain, gaussian = (outcome.median(name) for name in WEIGHTINGS)
    return (
        "What their figure 6 shows: RMS error of k1 on a torus (k1 = 2.5) of 2000 points with 0.25 % noise and exact "
        "normals, medians.\n\n"
        + markdown_table(
            ["weights", "RMS of k1"], [["M", number(m)], ["none", number(plain)], ["Gaussian", number(gaussian)]]
        )
        + "\n"
        + table([row("M / none", m / plain, Bound(0.5)), row("M / Gaussian", m / gaussian, Bound(0.2))])
    )


def projected(positions: np.ndarray, normals: np.ndarray, proxy: np.ndarray, **parameters: object) -> np.ndarray:
    """The proxy points (M x 3) on the surface of the cloud (N x 3 each)."""
    meshes = layer(positions, normals)
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=proxy))
    run_on(meshes, PROJECT, control_mesh=0, proxy_mesh=1, **parameters)
    return meshes.mesh(1).vertex_matrix()


def least_squares(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """On the moving-least-squares surface that the ray tracer compares with (N x 3); in another order."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, moved = Path(folder) / "cloud.bin", Path(folder) / "moved.bin"
        write_cloud(cloud, positions, normals)
        output_of("project", cloud, moved)
        return np.fromfile(moved).reshape(-1, 3)


POINTS, DISPLACED = 20000, 4000  # of the torus whose points are projected
SPACING = float(np.sqrt(TORUS_AREA / POINTS))


def projection_figures(seed: int) -> Figures:
    """Of clean points displaced by 0.3 spacings: distances in spacings. Of noisy points: RMS distance, after over before."""
    made = analytic_surfaces.generate("torus", POINTS, seed=seed)
    scatter = np.random.default_rng(seed).normal(scale=0.3 * SPACING, size=(DISPLACED, 3))
    once = projected(made["positions"], made["normals"], made["positions"][:DISPLACED] + scatter)
    twice = projected(made["positions"], made["normals"], once)

    noisy, normals = generated("torus", POINTS, noise=0.005, neighbors=PAPER_PLANE_FIT_NEIGHBORS, seed=seed)
    positions = noisy["positions"]
    moved = {name: projected(positions, normals, positions, diffusion_function=name) for name in DIFFUSIONS}
    moved["squares"] = least_squares(positions, normals)
    moved["denoising"] = run_filter(DENOISE, positions, normals).vertices
    before = rms_distance("torus", positions)
    return {
        "off": rms_distance("torus", once) / SPACING,
        "again": rms(np.linalg.norm(twice - once, axis=1)) / SPACING,
        **{name: rms_distance("torus", points) / before for name, points in moved.items()},
    }


@BENCHMARK.experiment("projection", "Projection")
def projection(settings: Settings) -> str:
    middle = over_seeds("projection", settings.seeds, projection_figures).median
    rows = [
        row("clean: RMS distance to the surface, spacings", middle("off"), Bound(0.01)),
        row("clean: P(P(r)) − P(r), RMS, spacings", middle("again"), Bound(1e-3)),
        row("0.5 % noise: RMS after / before, defaults (Hermite)", middle("Hermite"), Bound(0.35)),
        *(row(f"the same, {name} (as published)", middle(name)) for name in ("Cutoff", "Rational")),
        row("the same by moving least squares, as traced below", middle("squares")),
        row("the same by *Denoise Point Cloud by Robust Curvature*, whose scale adapts", middle("denoising")),
    ]
    return (
        f"Torus of {POINTS} points; spacing: root of the area per point. Clean: {DISPLACED} of the points displaced by 0.3 "
        f"spacings per axis. Noisy: all points, normals are planes fitted to {PAPER_PLANE_FIT_NEIGHBORS} neighbours. Medians.\n\n"
        + table(rows)
    )


def shape(name: str, data: Path) -> tuple[np.ndarray, np.ndarray]:
    return oriented_vertices(data / SHAPES[name])


def compared(name: str, data: Path) -> dict:
    """What point_set_surfaces.cpp says of both surfaces."""
    with tempfile.TemporaryDirectory() as folder:
        cloud = Path(folder) / "cloud.bin"
        write_cloud(cloud, *shape(name, data))
        return json.loads(output_of("compare", cloud, WIDTH, HEIGHT, RUNS))


@BENCHMARK.experiment("images", "Ray tracing of both surfaces")
def images(settings: Settings) -> str:
    if settings.data is None:
        return "Left out: run with `--data FOLDER`.\n"
    rows = []
    for name in SHAPES:
        progress(f"images of {name}")
        found = compared(name, settings.data)
        driven, squares = median(found["driven"]), median(found["squares"])
        ratio, agreement, depth = squares / driven, 100.0 * found["agreement"], found["depth_difference"]
        cells = [name, f"{driven:.3f}", f"{squares:.3f}", f"{ratio:.2f}", yes(ratio >= 1.5)]
        rows.append([*cells, f"{agreement:.2f}", yes(agreement >= 99.5), f"{depth:.3f}", yes(depth < 0.2)])
    header = ["shape", "curvature-driven, s", "moving least squares, s", "ratio", "≥ 1.5"]
    header += ["pixels that agree, %", "≥ 99.5", "mean depth difference, spacings", "< 0.2"]
    return (
        f"Their figure 7 and their claim, 1.5 to 2.5 times faster than moving least squares: rays of {WIDTH} × {HEIGHT} "
        f"pixels, both surfaces in one process on the same neighbourhoods, medians of {RUNS} runs each, each first "
        "half of the time. Other work may have run on the machine: trust the ratios more than the seconds. Preparation "
        "(neighbourhoods, spheres), the same for both, is not in them; colours and the smoothing of outlines neither. The "
        "bandwidths are those that leave about as much noise (see Projection): 1.6 spacings here, 2 of moving least squares, "
        "whose complete quadratics need more points for it.\n\n"
        + markdown_table(header, rows)
        + "\nBoth surfaces share what finds and gathers the points around a ray. Where a point covers many pixels that is "
        "done once for many rays, and what is left differs; of the dragon, whose points are as dense as the pixels, nearly "
        "every ray meets a point of its own, and gathering its neighbours is most of the work of both.\n"
    )


@BENCHMARK.experiment("filter", "Pictures from start to end")
def whole_filter(settings: Settings) -> str:
    if settings.data is None:
        return "Left out: run with `--data FOLDER`.\n"
    rows = []
    for name in SHAPES:
        for surface in ("Curvature-Driven", "Moving Least Squares"):
            progress(f"filter on {name}, {surface}")
            cloud = shape(name, settings.data)
            with tempfile.TemporaryDirectory() as folder:
                ran = run_filter(RAY_TRACE, *cloud, image_file=str(Path(folder) / "image.png"), surface=surface)
            seconds = [ran.report["seconds_preparation"], ran.report["seconds_rendering"], ran.seconds]
            fast_enough = yes(ran.seconds < 60.0) if name == "dragon" else ""
            rows.append([name, str(ran.report["points"]), surface, *(f"{value:.2f}" for value in seconds), fast_enough])
    header = ["shape", "points", "surface", "preparation, s", "rendering, s", "whole filter, s", "< 60 s"]
    return f"The filter with its defaults, {WIDTH} × {HEIGHT}, PNG written, one run.\n\n" + markdown_table(header, rows)


if __name__ == "__main__":
    main(BENCHMARK)
