# How well, and how fast, our filters reject outliers and denoise, beside what we hold them to and beside other tools
# on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/cleaning.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np

import comparison
import experiments
import measures
from cleaning_clouds import (
    EDGE_ZONE,
    PLANE_FIT_NEIGHBORS,
    SMOOTH_NORMALS_NEIGHBORS,
    Cloud,
    denoising_figures,
    grooved,
    part_selection_figures,
    quarters_alone,
    ratio_figures,
    sampled,
    selection_figures,
    uneven,
    with_clean_mesh,
)
from comparison import Case, Column, Figures, Method, Outcome, Target, number, one, verdict
from experiments import Settings
from fresh_process import cost_of
from peers.cgal_cleaning import bilateral_smoothing, jet_smoothing, removed_outliers
from peers.cleaned import Moved, Selection
from peers.meshlab_cleaning import apss_projection, local_outlier_probabilities
from peers.open3d_outliers import open3d_version, radius_outliers, statistical_outliers
from peers.programs import cgal_version

OUTLIERS = "compute_selection_point_cloud_outliers_by_curvature"
DENOISE = "apply_coord_point_cloud_robust_denoising"
TIMED_RUNS = 3
LARGE_SCAN = "dragon_vrip.ply"

Result = Selection | Moved


def our_selection(cloud: Cloud) -> Selection:
    meshes = measures.layer(cloud.positions, cloud.normals)
    start = time.perf_counter()
    meshes.apply_filter(OUTLIERS)
    return Selection(meshes.current_mesh().vertex_selection_array(), time.perf_counter() - start)


def our_denoising(cloud: Cloud) -> Moved:
    meshes = measures.layer(cloud.positions, cloud.normals)
    start = time.perf_counter()
    meshes.apply_filter(DENOISE)
    return Moved(meshes.current_mesh().vertex_matrix(), time.perf_counter() - start)


def loop_at(probability: float) -> Method:
    return lambda cloud: local_outlier_probabilities(cloud.positions, probability, 32)


def statistical_at(neighbors: int, deviations: float) -> Method:
    return lambda cloud: statistical_outliers(cloud.positions, neighbors, deviations)


def radius_at(neighbors: int, spacings: float) -> Method:
    return lambda cloud: radius_outliers(cloud.positions, neighbors, spacings * cloud.spacing)


def true_share_removed(cloud: Cloud) -> Selection:
    return removed_outliers(cloud.positions, cloud.normals, 24, 100.0 * float(cloud.outlier.mean()))


def selecting_peers() -> list[Column]:
    columns = [
        one("LoOP, default", loop_at(0.8)),
        one("LoOP, 0.5", loop_at(0.5)),
        one("CGAL remove_outliers, true share", true_share_removed),
    ]
    if open3d_version() is None:
        return columns
    return [
        *columns,
        one("Open3D statistical 20, 2", statistical_at(20, 2.0)),
        Column(
            "best of Open3D statistical",
            {f"Open3D statistical {k}, {d:g}": statistical_at(k, d) for k, d in ((20, 2.0), (20, 0.5), (30, 1.0))},
        ),
        one("Open3D radius 16, 3.5 h", radius_at(16, 3.5)),
    ]


def apss_at(scale: float, smooth_normals: bool = False) -> Method:
    return lambda cloud: apss_projection(
        cloud.positions, cloud.smooth_normals if smooth_normals else cloud.normals, scale
    )


def apss_in_one_layer(cloud: Cloud) -> Moved | None:
    return apss_projection(cloud.positions, cloud.normals, 2, one_layer=True)


def jet_at(neighbors: int) -> Method:
    return lambda cloud: jet_smoothing(cloud.positions, cloud.normals, neighbors)


def bilateral_at(neighbors: int, degrees: float, iterations: int, smooth_normals: bool = False) -> Method:
    return lambda cloud: bilateral_smoothing(
        cloud.positions, cloud.smooth_normals if smooth_normals else cloud.normals, neighbors, degrees, iterations
    )


def moving_peers() -> list[Column]:
    return [
        one("APSS, as it comes", apss_in_one_layer),
        one("APSS 2", apss_at(2)),
        Column("best APSS", {"APSS 2": apss_at(2)} | {f"APSS {s}": apss_at(s, smooth_normals=True) for s in (4, 12)}),
        one("CGAL jet 24", jet_at(24)),
        Column("best CGAL jet", {f"CGAL jet {k}": jet_at(k) for k in (24, 50, 100, 400, 800)}),
        one("CGAL bilateral 24, 30°, 1", bilateral_at(24, 30.0, 1)),
        Column(
            "best CGAL bilateral",
            {
                "CGAL bilateral 24, 30°, 1": bilateral_at(24, 30.0, 1),
                "CGAL bilateral 100, 30°, 1": bilateral_at(100, 30.0, 1, smooth_normals=True),
                "CGAL bilateral 100, 15°, 3": bilateral_at(100, 15.0, 3, smooth_normals=True),
            },
        ),
    ]


def compare(
    cases: list[Case],
    settings: Settings,
    ours: Method,
    peers: Callable[[], list[Column]] | None,
    figures: Callable[[Cloud, Result], Figures],
) -> str:
    return comparison.compare(
        [case for case in cases if case.quick or not settings.quick],
        settings.seeds,
        ours,
        peers() if peers and settings.peers else [],
        figures,
        lambda name: name.endswith(("recall", "precision")),
    )


def selected(recall: tuple[float, float], precision: tuple[float, float] = (0.98, 0.99)) -> dict[str, Target]:
    return {"recall": Target(*recall, at_least=True), "precision": Target(*precision, at_least=True)}


def far_outliers(settings: Settings) -> str:
    torus = selected((0.96, 0.98))
    cube = {"recall": Target(0.94, 0.97, at_least=True), "inliers selected, %": Target(0.1, 0.05)}
    cases = [
        Case("torus 20 000, 0.25 %, 5 % far", sampled("torus", 20000, 0.0025, far=0.05), torus, quick=True),
        Case("torus 20 000, 0.25 %, 10 % far", sampled("torus", 20000, 0.0025, far=0.1), torus),
        Case("cube 60 000, 0.5 %, 5 % far", sampled("cube", 60000, 0.005, far=0.05), cube),
    ]
    return "Outliers anywhere in 1.2 times the box.\n\n" + compare(
        cases, settings, our_selection, selecting_peers, selection_figures
    )


def near_outliers(settings: Settings) -> str:
    recalls = {0.0: (0.99, 1.0), 0.0025: (0.84, 0.92), 0.005: (0.88, 0.92)}
    cases = [
        Case(
            f"torus 20 000, {100 * noise:g} %, 5 % near",
            sampled("torus", 20000, noise, near=0.05),
            selected(recall, (0.98, 0.98)),
            quick=noise == 0.005,
        )
        for noise, recall in recalls.items()
    ]
    return "Clusters of 12 points, 3 to 8 noise units off the surface.\n\n" + compare(
        cases, settings, our_selection, selecting_peers, selection_figures
    )


def clean(settings: Settings) -> str:
    targets = {"inliers selected, %": Target(0.1, 0.0)}
    cases = [
        Case(f"{surface} 20 000, {label}", sampled(surface, 20000, noise), targets, quick=surface == "cube")
        for noise, label in ((0.0, "clean"), (0.0025, "0.25 %"))
        for surface in ("torus", "cube", "helicoid")
    ]
    cases += [
        Case(f"sheet 20 000, groove of {width:g} spacings", grooved(20000, width), targets, quick=width == 3.0)
        for width in (3.0, 6.0)
    ]
    return (
        "Groove: a Gaussian valley, as deep as its half width at 1/e, that width in spacings.\n\n"
        + compare(cases, settings, our_selection, selecting_peers, selection_figures)
    )


def denoised(ratio: tuple[float, float], **more: tuple[float, float]) -> dict[str, Target]:
    common = {"signed mean": Target(0.03, 0.03), "CV of spacing": Target(0.56, 0.56)}
    return {"RMS ratio": Target(*ratio), **{name: Target(*bounds) for name, bounds in more.items()}, **common}


def smooth(settings: Settings) -> str:
    ratios = {0.0025: (0.105, 0.08), 0.005: (0.09, 0.07), 0.01: (0.09, 0.065), 0.02: (0.11, 0.08)}
    cases = [
        Case(
            f"torus 20 000, {100 * noise:g} %", sampled("torus", 20000, noise), denoised(ratio), quick=noise == 0.005
        )
        for noise, ratio in ratios.items()
    ]
    cases += [
        Case("torus 1600, 0.5 %", sampled("torus", 1600, 0.005), denoised((0.26, 0.21)), quick=True),
        Case(
            "helicoid 1730, 0.5 %",
            sampled("helicoid", 1730, 0.005),
            denoised((0.25, 0.20), **{"rim retreat": (1.0, 0.5)}),
            quick=True,
        ),
    ]
    return compare(cases, settings, our_denoising, moving_peers, denoising_figures)


def sharp(settings: Settings) -> str:
    dense = {"edges, RMS ratio": Target(0.27, 0.18), "elsewhere, RMS ratio": Target(0.10, 0.08)}
    common = {"signed mean": Target(0.03, 0.03), "CV of spacing": Target(0.56, 0.56)}

    def as_one(seed: int) -> Cloud:
        cloud = sampled("cube", 600, 0.005)(seed)
        return cloud.only(np.ones(len(cloud.positions), bool), {"": np.ones(len(cloud.positions), bool)})

    cases = [
        Case("cube 60 000, 0.5 %", sampled("cube", 60000, 0.005), dense | common),
        Case("cube 600, 0.5 %", as_one, {"RMS ratio": Target(0.7, 0.45)} | common, quick=True),
    ]
    return f"Edges: foot points within {100 * EDGE_ZONE:g} % of the side from an edge.\n\n" + compare(
        cases, settings, our_denoising, moving_peers, denoising_figures
    )


def uneven_cloud(settings: Settings) -> str:
    points = 20000

    def table(ours: Method, share: float, figures: Callable[[Cloud, Result], Figures]) -> str:
        rows, whole, alone = [], Outcome(), Outcome()
        for seed in settings.seeds:
            print(f"uneven cloud, {100 * share:g} % outliers, seed {seed}", file=sys.stderr)
            cloud = uneven(points, share)(seed)
            whole.add(figures(cloud, ours(cloud)))
            alone.add({name: value for part in quarters_alone(cloud) for name, value in figures(part, ours(part)).items()})
        for name in whole.names():
            together, apart = whole.median(name), alone.median(name)
            rows.append([name, number(together), number(apart), number(together / apart if apart else np.nan)])
        return measures.markdown_table(["figure", "whole cloud", "quarter alone", "whole / alone"], rows)

    return (
        f"Torus of some {points} points along which the noise grows from 0.1 to 1 % of the diagonal and, a quarter turn "
        "off, the density falls tenfold. The same points in the middle of each quarter, cleaned with the whole cloud and "
        "with the quarter alone. First 5 % far outliers, then denoising without outliers.\n\n"
        + table(our_selection, 0.05, part_selection_figures)
        + "\n"
        + table(our_denoising, 0.0, ratio_figures)
    )


def meshes_with_truth(settings: Settings) -> str:
    if settings.data is None:
        return "Skipped: `--data FOLDER` says where the meshes are.\n"
    folder = settings.data

    def fandisk(_: int) -> Cloud:
        return with_clean_mesh(folder / "fandisk_noise0.3.obj", folder / "fandisk_clean.obj")

    def twelve(_: int) -> Cloud:
        return with_clean_mesh(folder / "twelve_impulsive0.5.obj", folder / "twelve_clean.obj", impulsive=True)

    return (
        "Vertices of noisy meshes, distances to the clean mesh. The half of Twelve's vertices that impulses displaced "
        "are its outliers.\n\n"
        + compare(
            [Case("fandisk, 0.3 edges", fandisk, one_seed=True, quick=True)],
            settings,
            our_denoising,
            moving_peers,
            denoising_figures,
        )
        + "\n"
        + compare(
            [Case("twelve, impulses on half", twelve, one_seed=True, quick=True)],
            settings,
            our_selection,
            selecting_peers,
            selection_figures,
        )
    )


def time_table(
    filter_name: str, target: Target, peers: Callable[[], list[Column]], settings: Settings, clouds: dict[str, Cloud]
) -> str:
    columns = [column for column in peers() if column.title != "APSS, as it comes"] if settings.peers else []
    timed = {name: run for column in columns for name, run in column.methods.items()}
    rows = []
    for label, cloud in clouds.items():
        print(f"time: {filter_name}, {label}", file=sys.stderr)
        cost = min(cost_of(filter_name, cloud.positions, cloud.normals) for _ in range(TIMED_RUNS))
        row = [label, f"{cost.wall:.0f}", f"{cost.processor:.0f}", f"{cost.megabytes:.0f}", *verdict(cost.wall, target)]
        for run in timed.values():
            result = run(cloud)
            ratio = None if result is None else 1e6 * result.seconds / len(cloud.positions) / cost.wall
            row.append("crash" if ratio is None else f"{ratio:.2f}")
        rows.append(row)
    header = ["cloud", "ours, µs per point", "processor, µs per point", "peak, MB", "must", "aim", "met", *timed]
    return measures.markdown_table(header, rows)


def memory_rows(settings: Settings) -> str:
    scan = None if settings.data is None else settings.data / LARGE_SCAN
    if scan is None or not scan.exists():
        return f"Peak memory on a large scan: skipped, no `{LARGE_SCAN}` (`--data FOLDER` says where it is).\n"
    positions, normals = measures.oriented_vertices(scan)
    rows = []
    for label, filter_name in (("outliers", OUTLIERS), ("denoising", DENOISE)):
        print(f"memory: {label}, {LARGE_SCAN}", file=sys.stderr)
        cost = cost_of(filter_name, positions, normals)
        rows.append([label, f"{cost.megabytes:.0f}", *verdict(cost.megabytes, Target(2048.0, 2048.0)), f"{cost.wall:.0f}"])
    return (
        f"On {len(positions)} points (`{LARGE_SCAN}`, vertices and vertex normals):\n\n"
        + measures.markdown_table(["filter", "peak, MB", "must", "aim", "met", "µs per point"], rows)
    )


def time_and_memory(settings: Settings) -> str:
    sizes = (20000,) if settings.quick else (20000, 200000)
    dirty = {f"torus {n}, 0.25 %, 5 % far": sampled("torus", n, 0.0025, far=0.05)(1) for n in sizes}
    noisy = {f"torus {n}, {100 * s:g} %": sampled("torus", n, s)(1) for n in sizes for s in (0.005, 0.02)}
    return (
        f"Wall clock per point (all threads: `processor`), seed 1, fastest of {TIMED_RUNS} fresh processes, peers of one; "
        "where `processor` is well below the wall clock times the threads, the machine was busy with other work. Peers "
        "as ratios to ours: above 1 they are slower. Peak memory above the host with the cloud loaded.\n\nOutliers:\n\n"
        + time_table(OUTLIERS, Target(100.0, 40.0), selecting_peers, settings, dirty)
        + "\nDenoising:\n\n"
        + time_table(DENOISE, Target(150.0, 60.0), moving_peers, settings, noisy)
        + "\n"
        + ("" if settings.quick else memory_rows(settings))
    )


EXPERIMENTS = {
    "far": ("Far outliers", far_outliers),
    "near": ("Outliers in clusters near the surface", near_outliers),
    "clean": ("Selected though there are no outliers", clean),
    "smooth": ("Denoising of smooth surfaces", smooth),
    "sharp": ("Denoising of sharp edges", sharp),
    "uneven": ("Noise and density that vary tenfold", uneven_cloud),
    "meshes": ("Noisy meshes with known truth", meshes_with_truth),
    "time": ("Time and memory", time_and_memory),
}


def introduction(settings: Settings) -> str:
    text = (
        f"Our filters with default parameters. Medians of {'seed 1' if settings.quick else 'seeds 1 to 5'}. Input normals "
        f"are planes fitted to {PLANE_FIT_NEIGHBORS} neighbours in the dirty cloud, their side the true one. Noise is a "
        "fraction of the surface's diagonal. Outliers count from three noise units (at least 0.25 % of the diagonal) off "
        "the true surface; nearer ones are in neither count. **RMS ratio**: distance to the true surface, after over "
        "before. **Signed mean**: of the distance after, over the RMS before (0: neither shrunk nor grown). **CV of "
        "spacing**: standard deviation over mean of the distance to the nearest neighbour (0.52: random points on a "
        "surface, more: clumps). **Rim retreat**: how far foot points within one spacing of the rim moved inwards, 95 % "
        "quantile, in spacings (side of the square that each point has).\n"
    )
    if settings.peers:
        open3d = open3d_version()
        text += (
            f"\nPeers in the same run: PyMeshLab's `compute_selection_point_cloud_outliers` (LoOP, 32 neighbours, its "
            "default threshold 0.8 and 0.5) and `compute_mls_projection_apss` (filter scale; as it comes: one layer as "
            "both the surface and what is projected; elsewhere two equal layers); "
            f"CGAL {cgal_version()}: `remove_outliers` (24 neighbours, told the true share), `jet_smooth_point_set` "
            "(neighbours), `bilateral_smooth_point_set` (neighbours, sharpness angle, iterations); "
            + (
                f"Open3D {open3d}: statistical (neighbours, deviations) and radius filter (neighbours, radius)"
                if open3d
                else "Open3D could not be had or did not load (it needs libusb-1.0)"
            )
            + f". Best: of the settings in brackets, picked for each figure with the truth in hand; best APSS and "
            f"bilateral get planes of {SMOOTH_NORMALS_NEIGHBORS} neighbours as normals, which suit them better.\n"
        )
    return text


def main() -> None:
    parser = experiments.parser_of(EXPERIMENTS, __doc__, f"where {LARGE_SCAN} and the noisy meshes are")
    given = experiments.parse(parser, EXPERIMENTS)
    settings = Settings(quick=given.quick, peers=not given.without_peers, data=given.data)
    experiments.report("cleaning", "Cleaning", introduction(settings), EXPERIMENTS, settings, given)


if __name__ == "__main__":
    main()
