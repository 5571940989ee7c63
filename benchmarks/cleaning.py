# How well, and how fast, our filters reject outliers and denoise, beside what we hold them to and beside other tools
# on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from clouds.cleaning import (
    EDGE_ZONE,
    SMOOTH_NORMALS_NEIGHBORS,
    WAVE_NOISE,
    Cloud,
    doubled,
    grooved,
    quarters_alone,
    sampled,
    scanned,
    uneven,
    with_clean_mesh,
)
from clouds.denoising_limits import fillet, registered_badly, thin_disk, with_true_mesh
from clouds.flying_pixels import depth_camera, terrestrial_scan
from clouds.generated import PLANE_FIT_NEIGHBORS
from clouds.scans import LARGE_SCAN, found, oriented_vertices
from clouds.thin_shapes import REAL_SHAPES, SOLIDS, real_shape, rounded_wall
from clouds.unstructured import ball_of_points, grass, leaves, sphere_and
from figures.cleaning import (
    denoising_figures,
    error_figures,
    harm_figures,
    layer_figures,
    mixed_pixel_figures,
    part_selection_figures,
    ratio_figures,
    selection_figures,
    true_shape_figures,
)
from harness.command_line import Benchmark, Settings, main
from harness.comparison import Case, Comparison, Figures, Method, Outcome, methods_of
from harness.fresh_process import cost_of
from harness.our_filters import run_filter
from harness.report import markdown_table, progress
from harness.results import Moved, Selection
from harness.shared import DENOISE, OUTLIERS
from harness.verdicts import Target, number, verdict
from peers.cleaning_columns import CRASHING, moving_columns, selecting_columns
from peers.open3d_outliers import open3d_version
from peers.programs import cgal_version

TIMED_RUNS = 3
UNEVEN_POINTS = 20000
NOISY_FANDISK = "fandisk_noise0.3.obj", "fandisk_clean.obj"
NOISY_TWELVE = "twelve_impulsive0.5.obj", "twelve_clean.obj"

BENCHMARK = Benchmark("cleaning", "Cleaning", options=("quick", "peers"), data=f"{LARGE_SCAN} and the noisy meshes are")


def our_selection(cloud: Cloud) -> Selection:
    ran = run_filter(OUTLIERS, cloud.positions, cloud.normals)
    return Selection(ran.selected, ran.seconds)


def our_denoising(cloud: Cloud) -> Moved:
    ran = run_filter(DENOISE, cloud.positions, cloud.normals)
    return Moved(ran.vertices, ran.seconds, ran.report)


def our_selection_with_hair(cloud: Cloud) -> Selection:
    ran = run_filter(OUTLIERS, cloud.positions, cloud.normals, reject_unstructured=True)
    return Selection(ran.selected, ran.seconds)


SELECTING_HAIR = Comparison(our_selection_with_hair, selecting_columns, lambda name: name == "recall")
SELECTING = Comparison(our_selection, selecting_columns, lambda name: name.endswith(("recall", "precision")))
MOVING = Comparison(our_denoising, moving_columns)


def selected(recall: tuple[float, float], precision: tuple[float, float] = (0.98, 0.99)) -> dict[str, Target]:
    return {"recall": Target(*recall, at_least=True), "precision": Target(*precision, at_least=True)}


@BENCHMARK.experiment("far", "Far outliers")
def far_outliers(settings: Settings) -> str:
    torus = selected((0.96, 0.98))
    cube = {"recall": Target(0.94, 0.97, at_least=True), "inliers selected, %": Target(0.1, 0.05)}
    cases = [
        Case("torus 20 000, 0.25 %, 5 % far", sampled("torus", 20000, 0.0025, far=0.05), torus, quick=True),
        Case("torus 20 000, 0.25 %, 10 % far", sampled("torus", 20000, 0.0025, far=0.1), torus),
        Case("cube 60 000, 0.5 %, 5 % far", sampled("cube", 60000, 0.005, far=0.05), cube),
    ]
    return "Outliers anywhere in 1.2 times the box.\n\n" + SELECTING.table(cases, settings, selection_figures)


@BENCHMARK.experiment("near", "Outliers in clusters near the surface")
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
    return "Clusters of 12 points, 3 to 8 noise units off the surface.\n\n" + SELECTING.table(
        cases, settings, selection_figures
    )


@BENCHMARK.experiment("clean", "Selected though there are no outliers")
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
    return "Groove: a Gaussian valley, as deep as its half width at 1/e, that width in spacings.\n\n" + SELECTING.table(
        cases, settings, selection_figures
    )


@BENCHMARK.experiment("true", "True shapes, nothing to reject")
def true_shapes(settings: Settings) -> str:
    targets = {"inliers selected, %": Target(0.1, 0.02), "worst ball, %": Target(33.3, 10.0)}
    cases = [Case(label, solid, targets, quick=label.startswith("cone")) for label, solid in SOLIDS.items()]
    data = settings.data
    shapes = {label: data / name for label, name in REAL_SHAPES.items() if found(data, name)} if data else {}
    cases += [Case(label, real_shape(file), targets, one_seed=True) for label, file in shapes.items()]
    missing = "" if shapes else "Real shapes skipped: `--data FOLDER` says where they are.\n\n"
    return (
        "Exact solids of 10 000 random points with parts thinner than a patch, and shapes that are clean. Worst ball: the "
        "largest share of the points in a ball of 3 spacings around one of them that is lost; a third means that a tip or "
        "a rim is emptied.\n\n" + missing + SELECTING.table(cases, settings, true_shape_figures)
    )


@BENCHMARK.experiment("rounded", "Depth rounded to steps")
def rounded_depth(settings: Settings) -> str:
    targets = {"inliers selected, %": Target(0.5, 0.1)}
    cases = [
        Case(f"wall, step {step:g} noises, tilt {degrees:g}°", rounded_wall(step, degrees), targets, quick=step == 2.0)
        for step in (0.5, 1.0, 2.0, 3.0)
        for degrees in (0.0, 5.0, 20.0, 40.0)
    ]
    return "A wall of 8100 points, noise of .7 spacings, as a depth camera gives it.\n\n" + SELECTING.table(
        cases, settings, selection_figures
    )


@BENCHMARK.experiment("flying", "Flying pixels")
def flying_pixels(settings: Settings) -> str:
    camera = {"recall": Target(0.95, 0.99, at_least=True), "inliers selected, %": Target(0.1, 0.02)}
    scanner = {"recall": Target(0.94, 0.97, at_least=True), "ground selected, %": Target(0.05, 0.01)}
    cases = [
        Case(f"camera, {label}", depth_camera(resolution, objects), camera, quick=label == "one sphere")
        for label, resolution, objects in (
            ("one sphere", 1.0, 1),
            ("half the pixels", 0.7, 1),
            ("twice the pixels", 1.4, 1),
            ("four spheres", 1.0, 4),
        )
    ]
    cases += [Case(f"scanner, {step:g}° steps", terrestrial_scan(step), scanner) for step in (0.35, 0.25)]
    return (
        "Seven of ten pixels at a silhouette are anywhere between the two surfaces there. Camera: spheres .6 to .95 m away "
        "before a wall at 1.3 m, disparity noise .06 pixels. Scanner: ground 1 to 40 m away with eight posts, range noise "
        "3 mm. Inliers within the noise of the sensor are rejected also without flying pixels.\n\n"
        + SELECTING.table(cases, settings, mixed_pixel_figures)
    )


@BENCHMARK.experiment("unstructured", "Hair, leaves, grass")
def unstructured(settings: Settings) -> str:
    targets = {"recall": Target(0.8, 0.98, at_least=True), "inliers selected, %": Target(0.1, 0.02)}
    made = {
        "ball of random points": lambda noise: sphere_and(ball_of_points, noise),
        "leaves": lambda noise: sphere_and(leaves, noise),
        "grass": grass,
    }
    cases = [
        Case(f"{label}, noise {noise:g}", make(noise), targets, quick=noise == 0.1)
        for label, make in made.items()
        for noise in (0.0, 0.1, 0.3)
    ]
    return (
        "`reject_unstructured` on. Beside a sphere a ball of 2000 random points, or 400 leaves of eight points; on a plane 150 "
        "blades of 20 points, eight spacings high. Noise of the surface in spacings.\n\n"
        + SELECTING_HAIR.table(cases, settings, selection_figures)
    )


def denoised(ratio: tuple[float, float], **more: tuple[float, float]) -> dict[str, Target]:
    common = {"signed mean": Target(0.03, 0.03), "CV of spacing": Target(0.56, 0.56)}
    return {"RMS ratio": Target(*ratio), **{name: Target(*bounds) for name, bounds in more.items()}, **common}


@BENCHMARK.experiment("smooth", "Denoising of smooth surfaces")
def smooth(settings: Settings) -> str:
    ratios = {0.0025: (0.105, 0.08), 0.005: (0.09, 0.07), 0.01: (0.09, 0.065), 0.02: (0.11, 0.08)}
    cases = [
        Case(f"torus 20 000, {100 * noise:g} %", sampled("torus", 20000, noise), denoised(ratio), quick=noise == 0.005)
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
    return MOVING.table(cases, settings, denoising_figures)


@BENCHMARK.experiment("sharp", "Denoising of sharp edges")
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
    return f"Edges: foot points within {100 * EDGE_ZONE:g} % of the side from an edge.\n\n" + MOVING.table(
        cases, settings, denoising_figures
    )


@BENCHMARK.experiment("lines", "Scan lines and twins")
def scan_lines_and_twins(settings: Settings) -> str:
    left = {1.0: (0.12, 0.12), 5.0: (0.15, 0.12), 8.0: (0.2, 0.12), 12.0: (0.3, 0.12)}
    noisy = [
        Case(f"lines {ratio:g}:1", scanned(ratio, WAVE_NOISE), {"RMS ratio": Target(*bounds)}, quick=ratio == 12.0)
        for ratio, bounds in left.items()
    ]
    exact = [
        Case(
            f"lines {ratio:g}:1, no noise",
            scanned(ratio, 0.0),
            {"RMS error": Target(0.025, 0.0)},
            quick=ratio == 12.0,
        )
        for ratio in left
        if ratio > 1.0
    ]
    twins = [Case("torus 3000, 0.25 %", sampled("torus", 3000, 0.0025), {"RMS ratio": Target(0.22, 0.18)})] + [
        Case(
            f"the same twice, error {error:g}",
            doubled(3000, 0.0025, error),
            {"RMS ratio": Target(0.24, 0.18)},
            quick=error == 0.01,
        )
        for error in (1e-8, 1e-4, 0.01, 0.04)
    ]
    return (
        f"A wave, {WAVE_NOISE:g} high noise along z, on lines so many times as far apart as their points; errors made where "
        "there is no noise, in units of that noise; a torus and the same torus with a copy of each point, off by so many "
        "spacings in each coordinate.\n\n"
        + MOVING.table(noisy, settings, ratio_figures)
        + "\n"
        + MOVING.table(exact, settings, error_figures)
        + "\n"
        + MOVING.table(twins, settings, ratio_figures)
    )


PUBLIC_SET, PUBLIC_NOISE = "punet", 0.01


@BENCHMARK.experiment("harm", "Denoising where it can do harm")
def harm(settings: Settings) -> str:
    exact = {"RMS error, spacings": Target(0.01, 0.0), "largest, spacings": Target(0.1, 0.0)}
    improved = {"RMS ratio": Target(1.0, 0.5)}
    cases = [
        Case(f"fillet of {radius:g} spacings", fillet(radius), exact, quick=radius == 2.0)
        for radius in (0.5, 1.0, 2.0, 4.0)
    ]
    cases += [
        Case(f"{surface} {points}, exact", sampled(surface, points, 0.0), exact)
        for surface in ("torus", "cube")
        for points in (2000, 20000)
    ]
    cases += [
        Case(
            f"disk, {thickness:g} spacings thick, noise {noise:g}",
            thin_disk(thickness, noise),
            improved if noise else exact,
            quick=thickness == 1.0 and noise > 0.0,
        )
        for thickness in (1.0, 1.5, 2.0, 3.0)
        for noise in (0.0, 0.2)
    ]
    files = sorted((settings.data / PUBLIC_SET).glob("*.npz")) if settings.data else []
    for file in files:
        clean, noisy = "clean_10000", f"noisy_10000_{PUBLIC_NOISE:g}"
        cases += [
            Case(
                f"{file.stem}, {name}",
                lambda _, file=file, name=name: with_true_mesh(file, name, clean),
                targets,
                one_seed=True,
            )
            for name, targets in ((clean, exact), (noisy, improved))
        ]
    missing = (
        ""
        if files
        else f"Shapes of the public set skipped: `--data FOLDER` says where the folder `{PUBLIC_SET}` is.\n\n"
    )
    return (
        "Exact clouds, walls as thin as a few spacings, and ten shapes of the denoising set of PU-Net, clean and with "
        f"{100 * PUBLIC_NOISE:g} % noise; normals are the true ones. The limits of moves were chosen on the public set.\n\n"
        + missing
        + MOVING.table(cases, settings, harm_figures)
    )


@BENCHMARK.experiment("doubled", "Doubled layers")
def doubled_layers(settings: Settings) -> str:
    one = {"distance left": Target(0.1, 0.02), "told, %": Target(80.0, 95.0, at_least=True)}
    two = {"told, %": Target(80.0, 95.0, at_least=True)}
    cases = [
        Case(
            f"{surface}, {distance:g} spacings",
            registered_badly(surface, distance),
            one if distance <= 1.0 else two,
            quick=distance == 0.5,
        )
        for surface in ("torus", "cube")
        for distance in (0.2, 0.5, 1.0, 1.5, 2.0)
    ]
    cases += [
        Case(f"torus, ghost of a tenth, {distance:g} spacings", registered_badly("torus", distance, 0.1))
        for distance in (1.0, 2.0)
    ]
    return (
        "Two scans of one surface, registered so many spacings apart (.03 of noise); a layer that is told although its surface "
        "is there once: none in the section before.\n\n" + MOVING.table(cases, settings, layer_figures)
    )


def uneven_table(settings: Settings, ours: Method, share: float, figures: Callable[[Cloud, Any], Figures]) -> str:
    """``share`` of outliers; figures of the parts of the whole cloud, beside those of the parts cleaned alone."""
    whole, alone = Outcome(), Outcome()
    for seed in settings.seeds:
        progress(f"uneven cloud, {100 * share:g} % outliers, seed {seed}")
        cloud = uneven(UNEVEN_POINTS, share)(seed)
        whole.add(figures(cloud, ours(cloud)))
        alone.add({name: value for part in quarters_alone(cloud) for name, value in figures(part, ours(part)).items()})
    rows = []
    for name in whole.names():
        together, apart = whole.median(name), alone.median(name)
        rows.append([name, number(together), number(apart), number(together / apart if apart else np.nan)])
    return markdown_table(["figure", "whole cloud", "quarter alone", "whole / alone"], rows)


@BENCHMARK.experiment("uneven", "Noise and density that vary tenfold")
def uneven_cloud(settings: Settings) -> str:
    return (
        f"Torus of some {UNEVEN_POINTS} points along which the noise grows from 0.1 to 1 % of the diagonal and, a quarter turn "
        "off, the density falls tenfold. The same points in the middle of each quarter, cleaned with the whole cloud and "
        "with the quarter alone. First 5 % far outliers, then denoising without outliers.\n\n"
        + uneven_table(settings, our_selection, 0.05, part_selection_figures)
        + "\n"
        + uneven_table(settings, our_denoising, 0.0, ratio_figures)
    )


@BENCHMARK.experiment("meshes", "Noisy meshes with known truth")
def meshes_with_truth(settings: Settings) -> str:
    data = settings.data
    if data is None or not found(data, *NOISY_FANDISK, *NOISY_TWELVE):
        return "Skipped: `--data FOLDER` says where the meshes are.\n"
    fandisk, twelve = ([data / name for name in names] for names in (NOISY_FANDISK, NOISY_TWELVE))
    denoised = Case("fandisk, 0.3 edges", lambda _: with_clean_mesh(*fandisk), one_seed=True, quick=True)
    selected = Case(
        "twelve, impulses on half", lambda _: with_clean_mesh(*twelve, impulsive=True), one_seed=True, quick=True
    )
    return (
        "Vertices of noisy meshes, distances to the clean mesh. The half of Twelve's vertices that impulses displaced "
        "are its outliers.\n\n"
        + MOVING.table([denoised], settings, denoising_figures)
        + "\n"
        + SELECTING.table([selected], settings, selection_figures)
    )


def time_table(
    filter_name: str, target: Target, comparison: Comparison, settings: Settings, clouds: dict[str, Cloud]
) -> str:
    peers = methods_of(comparison.peers()) if settings.peers else {}
    peers.pop(CRASHING, None)
    rows = []
    for label, cloud in clouds.items():
        progress(f"time: {filter_name}, {label}")
        cost = cost_of(filter_name, cloud.positions, cloud.normals, TIMED_RUNS)
        row = [label, f"{cost.wall:.0f}", f"{cost.processor:.0f}", f"{cost.megabytes:.0f}", *verdict(cost.wall, target)]
        for run in peers.values():
            result = run(cloud)
            ratio = None if result is None else 1e6 * result.seconds / len(cloud.positions) / cost.wall
            row.append("crash" if ratio is None else f"{ratio:.2f}")
        rows.append(row)
    header = ["cloud", "ours, µs per point", "processor, µs per point", "peak, MB", "must", "aim", "met", *peers]
    return markdown_table(header, rows)


def memory_rows(settings: Settings) -> str:
    if settings.data is None or not found(settings.data, LARGE_SCAN):
        return f"Peak memory on a large scan: skipped, no `{LARGE_SCAN}` (`--data FOLDER` says where it is).\n"
    positions, normals = oriented_vertices(settings.data / LARGE_SCAN)
    rows = []
    for label, filter_name in (("outliers", OUTLIERS), ("denoising", DENOISE)):
        progress(f"memory: {label}, {LARGE_SCAN}")
        cost = cost_of(filter_name, positions, normals)
        rows.append(
            [label, f"{cost.megabytes:.0f}", *verdict(cost.megabytes, Target(2048.0, 2048.0)), f"{cost.wall:.0f}"]
        )
    return f"On {len(positions)} points (`{LARGE_SCAN}`, vertices and vertex normals):\n\n" + markdown_table(
        ["filter", "peak, MB", "must", "aim", "met", "µs per point"], rows
    )


@BENCHMARK.experiment("time", "Time and memory")
def time_and_memory(settings: Settings) -> str:
    sizes = (20000,) if settings.quick else (20000, 200000)
    dirty = {f"torus {n}, 0.25 %, 5 % far": sampled("torus", n, 0.0025, far=0.05)(1) for n in sizes}
    noisy = {f"torus {n}, {100 * s:g} %": sampled("torus", n, s)(1) for n in sizes for s in (0.005, 0.02)}
    return (
        f"Wall clock per point (all threads: `processor`), seed 1, fastest of {TIMED_RUNS} fresh processes, peers of one; "
        "where `processor` is well below the wall clock times the threads, the machine was busy with other work. Peers "
        "as ratios to ours: above 1 they are slower. Peak memory above the host with the cloud loaded.\n\nOutliers:\n\n"
        + time_table(OUTLIERS, Target(100.0, 40.0), SELECTING, settings, dirty)
        + "\nDenoising:\n\n"
        + time_table(DENOISE, Target(150.0, 60.0), MOVING, settings, noisy)
        + "\n"
        + ("" if settings.quick else memory_rows(settings))
    )


@BENCHMARK.introduction
def introduction(settings: Settings) -> str:
    text = (
        f"Our filters with default parameters. Medians of {settings.seeds_in_words}. Input normals "
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


if __name__ == "__main__":
    main(BENCHMARK)
