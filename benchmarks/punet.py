# Sides of normals, and denoising without normals, on the public denoising set of PU-Net.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from clouds.punet import FOLDER, SERIES, PublicCloud, public_cloud, shapes_in
from figures.punet import chamfer_distance, unsigned_angle, wrong_sides
from harness.command_line import Benchmark, Settings, main
from harness.our_filters import Ran, run_on
from harness.report import markdown_table, progress
from harness.shared import DENOISE, NORMALS, layer
from harness.verdicts import Target, number, verdict
from peers.cgal_cleaning import bilateral_smoothing, jet_smoothing
from peers.meshlab_cleaning import apss_projection

JET_NEIGHBORS = 24
BILATERAL = 24, 30.0, 1  # neighbours, degrees, iterations
APSS_SCALE = 4.0

BENCHMARK = Benchmark("punet", "Public denoising set", options=("quick", "peers"), data=f"the folder `{FOLDER}` is")

Key = tuple[int, float]  # of SERIES
# Of the mean of the shapes: points on the wrong side, %.
SIDES: dict[Key, Target] = {
    (10000, 0.0): Target(0.13, 0.1),
    (10000, 0.01): Target(1.26, 0.8),
    (10000, 0.02): Target(4.8, 3.0),
    (10000, 0.03): Target(7.0, 5.0),
    (50000, 0.01): Target(1.05, 0.7),
    (50000, 0.02): Target(4.0, 2.5),
}
# Chamfer distances of a first recipe on these ten shapes, 1e-4, of 10 000 points; we ask for less than that.
RECIPE = {
    "Icosahedron": (3.18, 5.95, 6.01),
    "camel": (1.60, 2.62, 4.63),
    "casting": (3.05, 6.43, 7.80),
    "chair": (1.85, 3.74, 7.34),
    "cow": (1.72, 2.63, 4.11),
    "eight": (1.76, 2.35, 2.42),
    "elk": (2.61, 3.96, 5.74),
    "fandisk": (2.00, 2.91, 4.04),
    "kitten": (2.20, 2.93, 3.74),
    "quadric": (1.89, 2.79, 5.12),
}
NOISES = 0.01, 0.02, 0.03  # of its columns
LESS = {0.01: (0.02, 0.10), 0.02: (0.06, 0.12), 0.03: (0.10, 0.20)}  # must, aim
DENSE = {0.01: Target(0.64, 0.59), 0.02: Target(1.05, 0.90)}  # with 50 000 points
# Means of all twenty shapes, from the tables of the papers: P2P-Bridge (ECCV 2024), IterativePFN (CVPR 2023).
PUBLISHED = {
    (10000, 0.01): (2.31, 2.28),
    (10000, 0.02): (3.43, 3.20),
    (10000, 0.03): (5.24, 3.99),
    (50000, 0.01): (0.66, 0.59),
    (50000, 0.02): (1.05, 0.90),
}


def series_of(settings: Settings, noisy: bool) -> list[Key]:
    return [key for key in SERIES if (key[1] > 0.0 or not noisy) and (key[0] == 10000 or not settings.quick)]


def title(count: int, noise: float) -> str:
    return f"{count // 1000}K, {100.0 * noise:g} %"


def missing() -> str:
    return f"Skipped: `--data FOLDER` says where the folder `{FOLDER}` is.\n"


def with_normals(cloud: PublicCloud) -> Ran:
    return run_on(layer(cloud.positions), NORMALS)


@BENCHMARK.experiment("sides", "Normals and their sides")
def sides(settings: Settings) -> str:
    shapes = shapes_in(settings.data)
    if not shapes:
        return missing()
    rows = []
    for count, noise in series_of(settings, noisy=False):
        wrong, angle, seconds, told = [], [], [], []
        for file in shapes:
            progress(f"{file.stem}, {title(count, noise)}")
            cloud = public_cloud(file, count, noise)
            ran = with_normals(cloud)
            wrong.append(wrong_sides(cloud, ran.normals))
            angle.append(unsigned_angle(cloud, ran.normals))
            told.append(100.0 * ran.report["doubtful_share"])
            seconds.append(ran.seconds)
        rows.append(
            [
                title(count, noise),
                *(number(value) for value in wrong),
                number(float(np.mean(wrong))),
                *verdict(float(np.mean(wrong)), SIDES[count, noise]),
                number(float(np.mean(told))),
                number(float(np.mean(angle))),
                number(float(np.mean(seconds))),
            ]
        )
    names = [file.stem for file in shapes]
    header = ["cloud", *names, "mean", "must", "aim", "met", "in doubt, %", "angle", "seconds"]
    return (
        "Points whose normal looks inward, %; a shape flipped as a whole counts whole. Raw clouds without normals, "
        "defaults. Must and aim are of the mean of twenty shapes, ten of which are these. In doubt: what the filter says "
        "itself. Angle: mean to the true normal whatever the side, degrees.\n\n" + markdown_table(header, rows)
    )


def target_of(name: str, count: int, noise: float) -> Target | None:
    if count != 10000 or name not in RECIPE:
        return None
    (must, aim), recipe = LESS[noise], RECIPE[name][NOISES.index(noise)]
    return Target((1.0 - must) * recipe, (1.0 - aim) * recipe)


def mean_target(names: list[str], count: int, noise: float) -> Target | None:
    if count != 10000:
        return DENSE[noise]
    targets = [target for name in names if (target := target_of(name, count, noise))]
    if len(targets) < len(names):
        return None
    return Target(float(np.mean([t.must for t in targets])), float(np.mean([t.aim for t in targets])))


def moved_by_all(cloud: PublicCloud, peers: bool) -> dict[str, np.ndarray]:
    oriented = with_normals(cloud)
    positions, normals = oriented.vertices, oriented.normals
    moved = {
        "noisy": cloud.positions,
        "ours": run_on(oriented.meshes, DENOISE).vertices,
        "ours, true sides": run_on(layer(positions, facing(normals, cloud.outward)), DENOISE).vertices,
    }
    if peers:
        moved["CGAL jet 24"] = jet_smoothing(positions, normals, JET_NEIGHBORS).positions
        moved["CGAL bilateral 24"] = bilateral_smoothing(positions, normals, *BILATERAL).positions
        apss = apss_projection(positions, normals, APSS_SCALE)
        moved["APSS 4"] = np.full_like(positions, np.nan) if apss is None else apss.positions
    return moved


def facing(normals: np.ndarray, outward: np.ndarray) -> np.ndarray:
    """The same normals, on the true side."""
    return np.where(np.einsum("ij,ij->i", normals, outward)[:, None] < 0.0, -normals, normals)


def distance_of(cloud: PublicCloud) -> Callable[[np.ndarray], float]:
    return lambda moved: chamfer_distance(cloud, moved) if np.isfinite(moved).all() else np.nan


@BENCHMARK.experiment("denoising", "Denoising without normals")
def denoising(settings: Settings) -> str:
    shapes = shapes_in(settings.data)
    if not shapes:
        return missing()
    rows, columns = [], []
    for count, noise in series_of(settings, noisy=True):
        found: list[dict[str, float]] = []
        for file in shapes:
            progress(f"{file.stem}, {title(count, noise)}")
            cloud = public_cloud(file, count, noise)
            measure = distance_of(cloud)
            found.append({name: measure(moved) for name, moved in moved_by_all(cloud, settings.peers).items()})
            columns = list(found[-1])
            row = [title(count, noise), cloud.name, *(number(value) for value in found[-1].values())]
            rows.append(row + verdict(found[-1]["ours"], target_of(cloud.name, count, noise)) + ["", ""])
        means = {name: float(np.mean([figures[name] for figures in found])) for name in columns}
        goal = mean_target([file.stem for file in shapes], count, noise)
        row = [title(count, noise), "**mean**", *(number(value) for value in means.values())]
        rows.append(row + verdict(means["ours"], goal) + [number(value) for value in PUBLISHED[count, noise]])
    header = ["cloud", "shape", *columns, "must", "aim", "met", "IterativePFN, of twenty", "P2P-Bridge, of twenty"]
    return (
        "Chamfer distance, 1e-4. Raw clouds without normals: sides are estimated first, for the peers as for us. Must and "
        "aim: of a first recipe less 2, 6 and 10 % (aim 10, 12 and 20 %) at 1, 2 and 3 %, shape by shape.\n\n"
        + markdown_table(header, rows)
    )


if __name__ == "__main__":
    main(BENCHMARK)
