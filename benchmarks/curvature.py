# How right our curvature is, and how fast, beside what we hold it to and beside other tools on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from clouds.curvature import RIM_MARGIN, Cloud, beside_edges, sampled, two_tori, wrong_normals
from clouds.generated import PLANE_FIT_NEIGHBORS
from clouds.scans import LARGE_SCAN, found, oriented_vertices
from figures.curvature import CLEAR_ANISOTROPY, edge_figures, inlier_figures, k1_figures, surface_figures
from harness.command_line import Benchmark, Settings, main
from harness.comparison import Case, Comparison, Figures
from harness.fresh_process import cost_of
from harness.our_filters import robust_curvature
from harness.report import markdown_table, progress
from harness.results import Estimate
from harness.shared import CURVATURE
from harness.verdicts import Target, verdict
from peers.curvature_columns import APSS_SCALES, JET_POINTS, JET_SETTINGS, apss_at, curvature_columns, jets_on
from peers.programs import cgal_version

TIMED_RUNS = 3

BENCHMARK = Benchmark(
    "curvature", "Curvature", options=("quick", "peers", "scale_mode"), data=f"{LARGE_SCAN} is, for the peak memory"
)


def estimated(settings: Settings, cloud: Cloud) -> Estimate:
    return robust_curvature(cloud.positions, cloud.normals, **settings.parameters)


def with_corrected_normals(settings: Settings, cloud: Cloud) -> Estimate:
    """Curvature of the default run, normals of one that corrects them."""
    corrected = robust_curvature(cloud.positions, cloud.normals, correct_normals=True, **settings.parameters)
    return replace(estimated(settings, cloud), normals=corrected.normals)


def compare(
    cases: list[Case],
    settings: Settings,
    figures: Callable[[Cloud, Estimate], Figures],
    ours: Callable[[Settings, Cloud], Estimate] = estimated,
) -> str:
    return Comparison(partial(ours, settings), curvature_columns).table(cases, settings, figures)


@BENCHMARK.experiment("torus", "Torus, by noise")
def torus(settings: Settings) -> str:
    targets = {
        0.0: {"H": Target(0.001, 0.0005)},
        0.0025: {"H": Target(0.022, 0.015)},
        0.005: {"H": Target(0.033, 0.02), "direction": Target(0.016, 0.010)},
        0.01: {"H": Target(0.046, 0.03), "direction": Target(0.025, 0.018)},
        0.02: {"H": Target(0.082, 0.06)},
    }
    cases = [
        Case(f"torus 20 000, {100 * noise:g} %", sampled("torus", 20000, noise), target, quick=noise == 0.005)
        for noise, target in targets.items()
    ]
    return compare(cases, settings, surface_figures)


@BENCHMARK.experiment("surfaces", "Other surfaces and densities")
def surfaces(settings: Settings) -> str:
    cases = [
        Case("ellipsoid 20 000, 0.5 %", sampled("ellipsoid", 20000, 0.005), {"H": Target(0.037, 0.03)}),
        Case("sphere 20 000, 0.5 %", sampled("sphere", 20000, 0.005), {"H": Target(0.009, 0.006)}),
        Case("cylinder 20 000, 0.5 %, inner", sampled("cylinder", 20000, 0.005), {"H": Target(0.02, 0.015)}),
        Case("helicoid 1730, 0.5 %, inner", sampled("helicoid", 1730, 0.005), {"H": Target(0.045, 0.03)}, quick=True),
        Case("torus 1600, clean", sampled("torus", 1600), {"H": Target(0.02, 0.01)}, quick=True),
        Case("torus 1600, 0.5 %", sampled("torus", 1600, 0.005), {"H": Target(0.07, 0.06)}),
        Case("torus 200 000, 0.5 %", sampled("torus", 200000, 0.005), {"H": Target(0.022, 0.015)}, one_seed=True),
    ]
    return compare(cases, settings, surface_figures)


@BENCHMARK.experiment("two_tori", "Two sizes in one cloud")
def two_sizes(settings: Settings) -> str:
    points, targets = 40000, {"large, H": Target(0.04, 0.025), "small, H": Target(0.15, 0.10)}
    cases = [
        Case("points shared equally", two_tori(points, 1 / 2), targets),
        Case("points by area", two_tori(points, 1 / 26), targets, quick=True),
    ]
    return (
        "Tori of size 1 and 1/5 in one cloud of 40 000 points, noise 0.25 % of the diagonal of the large one on both.\n\n"
        + compare(cases, settings, surface_figures)
    )


@BENCHMARK.experiment("outliers", "Outliers")
def outliers(settings: Settings) -> str:
    cases = [
        Case("1 % outliers", sampled("torus", 20000, 0.0025, 0.01), {"H": Target(0.03, 0.022)}),
        Case("5 % outliers", sampled("torus", 20000, 0.0025, 0.05), {"H": Target(0.05, 0.022)}, quick=True),
    ]
    return (
        "Torus of 20 000 points, 0.25 % noise, far outliers anywhere in 1.2 times the box; errors on the inliers.\n\n"
        + compare(cases, settings, inlier_figures)
    )


@BENCHMARK.experiment("random_normals", "Random normals")
def random_normals(settings: Settings) -> str:
    cases = [
        Case(
            f"{100 * share:g} % random normals", wrong_normals(2000, share), {"k1 RMS": Target(0.05, 0.03)}, quick=True
        )
        for share in (0.15, 0.3)
    ]
    return (
        "Torus of 2000 points without noise, normals exact but for a share of random ones (k1 = 2.5). "
        "Jets do not look at normals.\n\n" + compare(cases, settings, k1_figures)
    )


@BENCHMARK.experiment("cube", "Sharp edges")
def cube(settings: Settings) -> str:
    figure = "normals RMS, degrees"
    cases = [
        Case("cube 60 000, clean", beside_edges(60000, 0.0), {figure: Target(2.0, 0.5)}),
        Case("cube 60 000, 0.5 %", beside_edges(60000, 0.005), {figure: Target(15.0, 8.0)}),
        Case("cube 6000, clean", beside_edges(6000, 0.0), {}, quick=True),
    ]
    return (
        "Points whose foot point is 0.5 to 1.5 spacings from an edge of a cube of side 1. Normals: those of the layer "
        "after `correct_normals`, or of the jet, against the face of the foot point. Abs k: the larger absolute principal "
        "curvature.\n\n" + compare(cases, settings, edge_figures, with_corrected_normals)
    )


def time_row(label: str, cloud: Cloud, settings: Settings) -> list[str]:
    progress(f"time: {label}")
    cost = cost_of(CURVATURE, cloud.positions, cloud.normals, TIMED_RUNS, **settings.parameters)
    row = [label, f"{cost.wall:.0f}", f"{cost.processor:.0f}", *verdict(cost.wall, Target(100.0, 40.0))]
    if settings.peers:
        for setting in JET_SETTINGS:
            seconds = min(jets_on(*setting)(cloud).seconds_per_point for _ in range(TIMED_RUNS))
            row.append(f"{1e6 * seconds / cost.wall:.2f}")
        for scale in APSS_SCALES:
            estimate = apss_at(scale)(cloud)
            row.append("crash" if estimate is None else f"{1e6 * estimate.seconds_per_point / cost.wall:.2f}")
    return row


def memory_row(settings: Settings) -> str:
    if settings.data is None or not found(settings.data, LARGE_SCAN):
        return f"Peak memory on a large scan: skipped, no `{LARGE_SCAN}` (`--data FOLDER` says where it is)."
    progress(f"memory: {LARGE_SCAN}")
    positions, normals = oriented_vertices(settings.data / LARGE_SCAN)
    cost = cost_of(CURVATURE, positions, normals, **settings.parameters)
    return (
        f"Peak memory at {len(positions)} points (`{LARGE_SCAN}`, vertices and vertex normals): **{cost.megabytes:.0f} MB** "
        f"above the host with the cloud loaded, {cost.wall:.0f} µs per point."
    )


@BENCHMARK.experiment("time", "Time and memory")
def time_and_memory(settings: Settings) -> str:
    sizes, noises = ((20000,), (0.005,)) if settings.quick else ((20000, 200000), (0.005, 0.02))
    rows = [
        time_row(f"torus {points}, {100 * noise:g} %", sampled("torus", points, noise)(1), settings)
        for points in sizes
        for noise in noises
    ]
    header = ["cloud", "ours, µs per point", "processor, µs per point", "must", "aim", "met"]
    if settings.peers:
        header += [f"jet ({degree}, {neighbors})" for degree, neighbors in JET_SETTINGS]
        header += [f"APSS {scale}" for scale in APSS_SCALES]
    return (
        f"Wall clock per point (all threads: `processor`), seed 1, fastest of {TIMED_RUNS} runs, APSS of one; "
        "where `processor` is well below the wall clock times the threads, the machine was busy with other work. Peers as "
        f"ratios to ours: above 1 they are slower. Jets (degree, k) at {JET_POINTS} of the points, search tree of all.\n\n"
        + markdown_table(header, rows)
        + "\n"
        + ("" if settings.quick else memory_row(settings) + "\n")
    )


@BENCHMARK.introduction
def introduction(settings: Settings) -> str:
    mode = settings.parameters.get("scale_mode")
    text = (
        f"Our filter with {f'`scale_mode` {mode}, otherwise ' if mode else ''}default parameters. Medians of "
        f"{settings.seeds_in_words}{'' if settings.quick else ' (torus 200 000: seed 1)'}. Input normals are planes fitted to "
        f"{PLANE_FIT_NEIGHBORS} neighbours, their side the true one, unless said otherwise. Noise is a fraction of the "
        "surface's diagonal. Truth is that of the foot point of the noisy point. **H**: RMS of |H - true H| / |true H|, "
        "over the RMS curvature where H vanishes somewhere (helicoid). **Direction**: mean angle of d1 in radians where "
        f"k1 - k2 exceeds {100 * CLEAR_ANISOTROPY:g} % of the RMS curvature. Inner: farther than {RIM_MARGIN} from the rim.\n"
    )
    if settings.peers:
        text += (
            f"\nPeers in the same run: jets of CGAL {cgal_version()} (`Monge_via_jet_fitting`) at {JET_POINTS} points of "
            "each cloud, at a usual setting, and at the best of degree 2 and 4 with 20, 50, 200 and 400 neighbours, "
            "picked for each figure with the truth in hand; PyMeshLab's `compute_curvature_and_color_apss_per_vertex` "
            "with the same input normals as ours, its default scale and the best known one, its K1 and K2 put in our "
            "order and its exchanged directions back.\n"
        )
    return text


if __name__ == "__main__":
    main(BENCHMARK)
