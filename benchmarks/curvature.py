# How right our curvature is, and how fast, beside what we hold it to and beside other tools on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/curvature.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

import experiments
import measures
from comparison import Figures, Outcome, Target, best_cell, number, verdict
from fresh_process import cost_of
from measures import analytic_surfaces
from peers.apss import DEFAULT_SCALE, apss
from peers.estimate import Estimate
from peers.jets import jets
from peers.programs import cgal_version

PLANE_FIT_NEIGHBORS = 16
RIM_MARGIN = 0.2
CLEAR_ANISOTROPY = 0.25  # of the curvature scale: where the principal directions can be judged
VANISHING = 0.05  # of the curvature scale: a mean curvature nobody can be wrong about relatively
JET_POINTS = 2000  # at which jets are evaluated: enough for an RMS
JET_USUAL = (2, 50)
JET_SETTINGS = [(degree, neighbors) for degree in (2, 4) for neighbors in (20, 50, 200, 400)]
APSS_SCALES = (DEFAULT_SCALE, 12)
TIMED_RUNS = 3
LARGE_SCAN = "dragon_vrip.ply"
CURVATURE = "compute_curvature_robust_per_vertex"

Truth = dict[str, np.ndarray]


@dataclass(frozen=True)
class Settings(experiments.Settings):
    parameters: dict[str, str] = field(default_factory=dict)  # of our filter, beyond its defaults


@dataclass(frozen=True)
class Cloud:
    """What the methods get, the truth at the foot points, and the parts the figures are of."""

    positions: np.ndarray
    normals: np.ndarray
    truth: Truth
    parts: dict[str, np.ndarray]  # name -> mask of points

    @staticmethod
    def whole(positions: np.ndarray, normals: np.ndarray, truth: Truth, mask: np.ndarray | None = None) -> Cloud:
        return Cloud(positions, normals, truth, {"": np.ones(len(positions), bool) if mask is None else mask})


@dataclass(frozen=True)
class Case:
    label: str
    make: Callable[[int], Cloud]  # of a seed
    targets: dict[str, Target]  # of figures
    quick: bool = False  # also in a quick run
    one_seed: bool = False


def sampled(surface: str, points: int, noise: float = 0.0, outliers: float = 0.0) -> Callable[[int], Cloud]:
    """Clouds with plane-fit normals; away from rims, and without the outliers in what is judged."""

    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate(surface, points, noise=noise, outliers=outliers, seed=seed)
        normals = analytic_surfaces.plane_fit_normals(made["positions"], made["normals"], PLANE_FIT_NEIGHBORS)
        judged = (made["rim_distance"] > RIM_MARGIN) & (made["label"] == analytic_surfaces.INLIER)
        return Cloud.whole(made["positions"], normals, made, judged)

    return make


def part_of(cloud: Cloud, mask: np.ndarray, estimate: Estimate) -> tuple[Truth, np.ndarray]:
    """Truth at the estimated points of a part of the cloud, and which of the estimates these are."""
    chosen = mask[estimate.points]
    points = estimate.points[chosen]
    return {key: values[points] for key, values in cloud.truth.items()}, chosen


def curvature_scale(truth: Truth) -> float:
    return float(np.sqrt(np.mean(truth["k1"] ** 2 + truth["k2"] ** 2) / 2.0))


def mean_curvature_errors(truth: Truth, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """Relative, per point; where the surface's own mean curvature vanishes, relative to the curvature scale."""
    mean = 0.5 * (truth["k1"] + truth["k2"])
    scale = curvature_scale(truth)
    reference = np.abs(mean) if np.abs(mean).min() > VANISHING * scale else scale
    return np.abs(0.5 * (k1 + k2) - mean) / reference


def direction_error(truth: Truth, d1: np.ndarray) -> float:
    clear = truth["k1"] - truth["k2"] > CLEAR_ANISOTROPY * curvature_scale(truth)
    return float(measures.angle_between_lines(d1[clear], truth["d1"][clear]).mean()) if clear.any() else np.nan


def figures_of(cloud: Cloud, estimate: Estimate) -> Figures:
    """Relative error of the mean curvature, mean angle of d1 in radians, per part."""
    figures = {}
    for name, mask in cloud.parts.items():
        truth, chosen = part_of(cloud, mask, estimate)
        errors = mean_curvature_errors(truth, estimate.k1[chosen], estimate.k2[chosen])
        prefix = f"{name}, " if name else ""
        figures[f"{prefix}H"] = measures.rms(errors)
        figures[f"{prefix}direction"] = direction_error(truth, estimate.d1[chosen])
    return figures


def inlier_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    errors = mean_curvature_errors(truth, estimate.k1[chosen], estimate.k2[chosen])
    return {"H": measures.rms(errors), "H, median": float(np.median(errors))}


def k1_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    return {"k1 RMS": measures.rms(estimate.k1[chosen] - truth["k1"])}


def edge_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    size = np.maximum(np.abs(estimate.k1[chosen]), np.abs(estimate.k2[chosen]))
    figures = {f"abs k, {percent} % quantile": float(np.percentile(size, percent)) for percent in (50, 90, 99)}
    if estimate.normals is not None:
        cosines = np.einsum("ij,ij->i", estimate.normals[chosen], truth["normals"])
        figures["normals RMS, degrees"] = measures.rms(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))
    return figures


def with_corrected_normals(ours: Callable[[Cloud], Estimate], settings: Settings) -> Callable[[Cloud], Estimate]:
    """Curvature of the default run, normals of one that corrects them."""

    def run(cloud: Cloud) -> Estimate:
        corrected = measures.robust_curvature(
            cloud.positions, cloud.normals, correct_normals=True, **settings.parameters
        )
        plain = ours(cloud)
        return Estimate(plain.points, plain.k1, plain.k2, plain.d1, corrected.normals, plain.seconds_per_point)

    return run


def some_points(cloud: Cloud) -> np.ndarray:
    """Of every part as many as its figures need, the same in every run."""
    chosen = np.random.default_rng(0)
    parts = [np.flatnonzero(mask) for mask in cloud.parts.values()]
    return np.concatenate([chosen.choice(part, min(len(part), JET_POINTS), replace=False) for part in parts])


Methods = dict[str, Callable[[Cloud], Estimate | None]]


def jets_on(settings: tuple[int, int]) -> Callable[[Cloud], Estimate]:
    degree, neighbors = settings
    return lambda cloud: jets(cloud.positions, cloud.truth["normals"], some_points(cloud), degree, neighbors)


def apss_at(scale: float) -> Callable[[Cloud], Estimate | None]:
    return lambda cloud: apss(cloud.positions, cloud.normals, scale)


def jet_name(setting: tuple[int, int]) -> str:
    return f"CGAL jet, degree {setting[0]}, k = {setting[1]}"


def apss_name(scale: float) -> str:
    return f"PyMeshLab APSS, filterscale {scale}"


def methods_of(settings: Settings) -> Methods:
    methods: Methods = {
        "ours": lambda cloud: measures.robust_curvature(cloud.positions, cloud.normals, **settings.parameters)
    }
    if settings.peers:
        methods.update({jet_name(setting): jets_on(setting) for setting in JET_SETTINGS})
        methods.update({apss_name(scale): apss_at(scale) for scale in APSS_SCALES})
    return methods


COMPARISON_HEADER = ["cloud", "figure", "ours", "worst seed", "must", "aim", "met"]
PEER_HEADER = [jet_name(JET_USUAL), "best CGAL jet (degree, k)", *(apss_name(scale) for scale in APSS_SCALES)]


def compare(
    cases: list[Case], settings: Settings, figures: Callable[[Cloud, Estimate], Figures], methods: Methods | None = None
) -> str:
    methods = methods or methods_of(settings)
    rows = []
    for case in cases:
        if settings.quick and not case.quick:
            continue
        outcomes = {name: Outcome() for name in methods}
        for seed in [1] if case.one_seed else settings.seeds:
            print(f"{case.label}, seed {seed}", file=sys.stderr)
            cloud = case.make(seed)
            for name, run in methods.items():
                estimate = run(cloud)
                outcomes[name].add(None if estimate is None else figures(cloud, estimate))
        ours = outcomes["ours"]
        for name in ours.names():
            if np.isnan(ours.median(name)):
                continue
            row = [case.label, name, number(ours.median(name)), number(ours.worst(name))]
            row += verdict(ours.median(name), case.targets.get(name))
            if settings.peers:
                row.append(outcomes[jet_name(JET_USUAL)].cell(name))
                jet_outcomes = {f"{degree}, {k}": outcomes[jet_name((degree, k))] for degree, k in JET_SETTINGS}
                row.append(best_cell(jet_outcomes, name))
                row += [outcomes[apss_name(scale)].cell(name) for scale in APSS_SCALES]
            rows.append(row)
    return measures.markdown_table(COMPARISON_HEADER + (PEER_HEADER if settings.peers else []), rows)


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
    return compare(cases, settings, figures_of)


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
    return compare(cases, settings, figures_of)


def two_tori_of(points: int, small_share: float) -> Callable[[int], Cloud]:
    small_size, offset = 0.2, np.array([2.0, 0.0, 0.0])
    sigma = 0.0025 * analytic_surfaces.surface("torus").diagonal

    def make(seed: int) -> Cloud:
        small = round(small_share * points)
        sizes = np.repeat([1.0, small_size], [points - small, small])
        centers = np.where((sizes < 1.0)[:, None], offset, 0.0)
        unit = [
            analytic_surfaces.generate("torus", count, seed=100 * which + seed)["positions"]
            for which, count in enumerate((points - small, small))
        ]
        positions = np.vstack(unit) * sizes[:, None] + centers
        positions += np.random.default_rng(seed).normal(scale=sigma, size=positions.shape)
        truth = analytic_surfaces.project("torus", (positions - centers) / sizes[:, None])
        truth["k1"], truth["k2"] = truth["k1"] / sizes, truth["k2"] / sizes
        normals = analytic_surfaces.plane_fit_normals(positions, truth["normals"], PLANE_FIT_NEIGHBORS)
        return Cloud(positions, normals, truth, {"large": sizes == 1.0, "small": sizes < 1.0})

    return make


def two_tori(settings: Settings) -> str:
    points, targets = 40000, {"large, H": Target(0.04, 0.025), "small, H": Target(0.15, 0.10)}
    cases = [
        Case("points shared equally", two_tori_of(points, 1 / 2), targets),
        Case("points by area", two_tori_of(points, 1 / 26), targets, quick=True),
    ]
    return (
        "Tori of size 1 and 1/5 in one cloud of 40 000 points, noise 0.25 % of the diagonal of the large one on both.\n\n"
        + compare(cases, settings, figures_of)
    )


def outliers(settings: Settings) -> str:
    cases = [
        Case("1 % outliers", sampled("torus", 20000, 0.0025, 0.01), {"H": Target(0.03, 0.022)}),
        Case("5 % outliers", sampled("torus", 20000, 0.0025, 0.05), {"H": Target(0.05, 0.022)}, quick=True),
    ]
    return (
        "Torus of 20 000 points, 0.25 % noise, far outliers anywhere in 1.2 times the box; errors on the inliers.\n\n"
        + compare(cases, settings, inlier_figures)
    )


def wrong_normals(points: int, share: float) -> Callable[[int], Cloud]:
    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate("torus", points, seed=seed)
        random = np.random.default_rng(seed)
        wrong = random.random(points) < share
        normals = made["normals"].copy()
        normals[wrong] = random.normal(size=(wrong.sum(), 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return Cloud.whole(made["positions"], normals, made)

    return make


def random_normals(settings: Settings) -> str:
    cases = [
        Case(f"{100 * share:g} % random normals", wrong_normals(2000, share), {"k1 RMS": Target(0.05, 0.03)}, quick=True)
        for share in (0.15, 0.3)
    ]
    return (
        "Torus of 2000 points without noise, normals exact but for a share of random ones (k1 = 2.5). "
        "Jets do not look at normals.\n\n" + compare(cases, settings, k1_figures)
    )


def beside_edges(points: int, noise: float) -> Callable[[int], Cloud]:
    spacing = np.sqrt(6.0 / points)

    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate("cube", points, noise=noise, seed=seed)
        normals = analytic_surfaces.plane_fit_normals(made["positions"], made["normals"], PLANE_FIT_NEIGHBORS)
        distance = made["feature_distance"] / spacing
        return Cloud.whole(made["positions"], normals, made, (distance > 0.5) & (distance < 1.5))

    return make


def cube(settings: Settings) -> str:
    figure = "normals RMS, degrees"
    cases = [
        Case("cube 60 000, clean", beside_edges(60000, 0.0), {figure: Target(2.0, 0.5)}),
        Case("cube 60 000, 0.5 %", beside_edges(60000, 0.005), {figure: Target(15.0, 8.0)}),
        Case("cube 6000, clean", beside_edges(6000, 0.0), {}, quick=True),
    ]
    methods = methods_of(settings)
    methods["ours"] = with_corrected_normals(methods["ours"], settings)
    return (
        "Points whose foot point is 0.5 to 1.5 spacings from an edge of a cube of side 1. Normals: those of the layer "
        "after `correct_normals`, or of the jet, against the face of the foot point. Abs k: the larger absolute principal "
        "curvature.\n\n" + compare(cases, settings, edge_figures, methods)
    )


def time_row(label: str, cloud: Cloud, settings: Settings) -> list[str]:
    print(f"time: {label}", file=sys.stderr)
    cost = min(cost_of(CURVATURE, cloud.positions, cloud.normals, settings.parameters) for _ in range(TIMED_RUNS))
    row = [label, f"{cost.wall:.0f}", f"{cost.processor:.0f}", *verdict(cost.wall, Target(100.0, 40.0))]
    if settings.peers:
        for setting in JET_SETTINGS:
            seconds = min(jets_on(setting)(cloud).seconds_per_point for _ in range(TIMED_RUNS))
            row.append(f"{1e6 * seconds / cost.wall:.2f}")
        for scale in APSS_SCALES:
            estimate = apss_at(scale)(cloud)
            row.append("crash" if estimate is None else f"{1e6 * estimate.seconds_per_point / cost.wall:.2f}")
    return row


def memory_row(settings: Settings) -> str:
    scan = None if settings.data is None else settings.data / LARGE_SCAN
    if scan is None or not scan.exists():
        return f"Peak memory on a large scan: skipped, no `{LARGE_SCAN}` (`--data FOLDER` says where it is)."
    print(f"memory: {LARGE_SCAN}", file=sys.stderr)
    positions, normals = measures.oriented_vertices(scan)
    cost = cost_of(CURVATURE, positions, normals, settings.parameters)
    return (
        f"Peak memory at {len(positions)} points (`{LARGE_SCAN}`, vertices and vertex normals): **{cost.megabytes:.0f} MB** "
        f"above the host with the cloud loaded, {cost.wall:.0f} µs per point."
    )


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
        + measures.markdown_table(header, rows)
        + "\n"
        + ("" if settings.quick else memory_row(settings) + "\n")
    )


EXPERIMENTS = {
    "torus": ("Torus, by noise", torus),
    "surfaces": ("Other surfaces and densities", surfaces),
    "two_tori": ("Two sizes in one cloud", two_tori),
    "outliers": ("Outliers", outliers),
    "random_normals": ("Random normals", random_normals),
    "cube": ("Sharp edges", cube),
    "time": ("Time and memory", time_and_memory),
}


def introduction(settings: Settings) -> str:
    mode = settings.parameters.get("scale_mode")
    text = (
        f"Our filter with {f'`scale_mode` {mode}, otherwise ' if mode else ''}default parameters. Medians of "
        f"{'seed 1' if settings.quick else 'seeds 1 to 5 (torus 200 000: seed 1)'}. Input normals are planes fitted to "
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


def main() -> None:
    parser = experiments.parser_of(EXPERIMENTS, __doc__, f"where {LARGE_SCAN} is, for the peak memory")
    parser.add_argument("--scale-mode", help="of our filter, instead of its default")
    given = experiments.parse(parser, EXPERIMENTS)
    settings = Settings(
        quick=given.quick,
        peers=not given.without_peers,
        data=given.data,
        parameters={"scale_mode": given.scale_mode} if given.scale_mode else {},
    )
    further = f" --scale-mode {given.scale_mode}" if given.scale_mode else ""
    experiments.report("curvature", "Curvature", introduction(settings), EXPERIMENTS, settings, given, further)


if __name__ == "__main__":
    main()
