# Traced lines of curvature (A09 sections 5.1 and 5.2) as numbers: where they lie, where they run, how far apart, and
# the mesh between them.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import partial

import numpy as np

from clouds.generated import PLANE_FIT_NEIGHBORS, oriented
from clouds.scans import found, oriented_vertices
from clouds.spacing import median_nearest_distance
from figures.lines import UMBILIC, angles, crossings, gaps, tilts, traced, wanted_spacing
from figures.mesh import PolygonMesh, distances, topology_is_right
from figures.surface import distance_to_surface, rms_distance
from harness.command_line import Benchmark, Settings, main
from harness.comparison import SEED_HEADER, Figures, over_seeds, seed_rows
from harness.our_filters import run_filter, run_on
from harness.report import markdown_table, progress
from harness.shared import CURVATURE, MESH, PIPELINE, TRACE, analytic_surfaces
from harness.verdicts import Target, number

PROJECTIONS = ("Mixed", "Locally Optimal", "Weighted Average")
COW = "cow_loop2_46433_derived.ply"
COW_BOUNDS = 0.003, 0.5  # of the diagonal
TARGET_VERTICES = 1600
STRAY = 2.0  # point spacings from the nearest point: a line has left the cloud, or is in a void of it
VOID = 1.0  # point spacings from the surface, which ends at its rim: within that it is a void
UMBILICAL = "sphere", "cube"  # k1 = k2 everywhere: every tangent is a principal direction
NONE = Target(0, 0)

BENCHMARK = Benchmark("lines", "Traced lines of curvature", options=("quick", "seeds"), data=f"{COW} is")


def judged(
    settings: Settings, label: str, targets: dict[str, Target], figures: Callable[..., Figures], *given: object
) -> list[list[str]]:
    """Rows of the figures that ``figures(*given, seed)`` finds."""
    return seed_rows(label, over_seeds(label, settings.seeds, partial(figures, *given)), targets)


def table(rows: list[list[str]]) -> str:
    return markdown_table(SEED_HEADER, rows)


def point_spacing(positions: np.ndarray) -> float:
    """The side of the square that each of random points has."""
    return 2.0 * median_nearest_distance(positions)


def mesh_figures(noise: float, seed: int) -> Figures:
    cloud = oriented("torus", 20000, noise, seed)
    mesh = PolygonMesh.of(run_filter(PIPELINE, *cloud, method="Traced Lines", target_vertices=TARGET_VERTICES))
    return {
        "wrong topology": float(not topology_is_right("torus", mesh)),
        "quads, %": 100 * mesh.topology.quad_share,
        "components": float(mesh.topology.components),
        "rims": float(mesh.topology.boundary_loops),
        "Euler characteristic": float(mesh.topology.euler_characteristic),
        "vertices": float(len(mesh.vertices)),
    }


@BENCHMARK.experiment("mesh", "The mesh between the lines")
def mesh(settings: Settings) -> str:
    rows = []
    for noise, quads in ((0.0, 95.0), (0.005, 92.0)):
        targets = {"wrong topology": NONE, "quads, %": Target(quads, 98, at_least=True)}
        rows += judged(settings, f"torus, {100 * noise:g} %", targets, mesh_figures, noise)
    return f"*Traced Lines*, 20 000 points, `target_vertices` {TARGET_VERTICES}.\n\n" + table(rows)


def noise_figures(noise: float, seed: int) -> Figures:
    positions, normals = oriented("torus", 16000, noise, seed)
    lines = traced(positions, normals, target_vertices=TARGET_VERTICES)
    before, after = (rms_distance("torus", points) for points in (positions, lines.vertices))
    return {"noise removed, %": 100.0 * (1.0 - after / before)}


@BENCHMARK.experiment("noise", "Noise removed")
def noise_removed(settings: Settings) -> str:
    rows = []
    for noise, must in ((0.005, 75.0), (0.01, 80.0)):
        targets = {"noise removed, %": Target(must, 88.0, at_least=True)}
        rows += judged(settings, f"torus, {100 * noise:g} %", targets, noise_figures, noise)
    return "RMS distance to the surface: 1 − line points / cloud points. 16 000 points.\n\n" + table(rows)


def direction_figures(surface: str, noise: float, seed: int) -> Figures:
    positions, normals = oriented(surface, 10000, noise, seed)
    lines = traced(positions, normals, target_vertices=TARGET_VERTICES)
    umbilical = surface in UMBILICAL
    off = tilts(surface, lines, point_spacing(positions)) if umbilical else angles(surface, lines)
    return {"mean angle, degrees": float(off.mean())}


@BENCHMARK.experiment("directions", "Angle to the true directions")
def directions(settings: Settings) -> str:
    rows = []
    for surface in ("torus", "ellipsoid", "helicoid", "cylinder", "capsule", *UMBILICAL):
        for noise, target in ((0.0, Target(0.3, 0.1)), (0.005, Target(2.0, 1.0))):
            targets = {"mean angle, degrees": target}
            rows += judged(settings, f"{surface}, {100 * noise:g} %", targets, direction_figures, surface, noise)
    return (
        f"10 000 points. Away from umbilics: |k1 − k2| above {100 * UMBILIC:g} % of its largest value. The capsule is the mixed "
        "umbilical surface of fig 8, umbilical at its caps and judged between them. On sphere and cube every "
        "tangent is a principal direction: the angle is that to the tangent plane, on the cube a point spacing and "
        "more from its edges.\n\n" + table(rows)
    )


SIZES = (1000, 2000, 4000, 8000, 16000)  # points, of the convergence
SLOPE = "slope of log RMS against log spacing"


def convergence_figures(seed: int) -> Figures:
    clouds = (oriented("torus", size, 0.0, seed) for size in SIZES)
    errors = [rms_distance("torus", traced(*cloud, target_vertices=400).vertices) for cloud in clouds]
    slope = float(np.polyfit(-0.5 * np.log(SIZES), np.log(errors), 1)[0])
    return {SLOPE: slope, **{f"RMS, {size} points": error for size, error in zip(SIZES, errors, strict=True)}}


@BENCHMARK.experiment("convergence", "Convergence")
def convergence(settings: Settings) -> str:
    targets = {SLOPE: Target(1.8, 2.5, at_least=True)}
    return "Torus without noise.\n\n" + table(judged(settings, "", targets, convergence_figures))


def mistake_figures(surface: str, noise: float, method: str, seed: int) -> Figures:
    positions, normals = oriented(surface, 10000, noise, seed)
    lines = traced(positions, normals, target_vertices=TARGET_VERTICES, method=method)
    spacing = point_spacing(positions)
    far = distances(lines.vertices, positions) > STRAY * spacing
    off = distance_to_surface(surface, lines.vertices) > VOID * spacing
    others, own = crossings(lines)
    return {
        "same-family crossings": float(others),
        "self-crossings": float(own),
        "lines astray": float(len(set(lines.line[far & off]))),
        "lines across voids": float(len(set(lines.line[far & ~off]))),
    }


@BENCHMARK.experiment("mistakes", "Crossings and lines that leave the cloud")
def mistakes(settings: Settings) -> str:
    targets = {"same-family crossings": NONE, "self-crossings": NONE, "lines astray": NONE}
    rows = []
    for surface in ("torus", "ellipsoid", "helicoid"):
        for noise in (0.0, 0.005):
            for method, kind in (("Traced Lines", ""), ("Position Field", ", position field")):
                label = f"{surface}{kind}, {100 * noise:g} %"
                rows += judged(settings, label, targets, mistake_figures, surface, noise, method)
    return (
        f"10 000 points. Astray: further than {STRAY:g} point spacings (twice the median distance between nearest "
        f"neighbours) from the nearest point and {VOID:g} from the surface, which ends at its rim. Nearer to the surface it is a void "
        "of the cloud: random ones of this size have a few, and lines have to cross them.\n\n" + table(rows)
    )


EPSILON = 0.0005  # of the diagonal, where the spacing is judged
SPACING_BOUNDS = 0.03, 0.3


def spacing_figures(noise: float, seed: int) -> Figures:
    least, most = SPACING_BOUNDS
    cloud = oriented("torus", 20000, noise, seed)
    lines = traced(*cloud, epsilon=EPSILON, min_spacing=least, max_spacing=most)
    truth = analytic_surfaces.project("torus", lines.middles)
    across = np.abs(np.where(lines.in_first_family, truth["k2"], truth["k1"]))
    error = EPSILON * analytic_surfaces.surface("torus").diagonal
    ratio = gaps(lines, np.clip(wanted_spacing(across, error), least, most))
    return {
        "within 0.7 to 2 d, %": 100.0 * float(np.mean((ratio >= 0.7) & (ratio <= 2.0))),
        "below 0.7 d, %": 100.0 * float(np.mean(ratio < 0.7)),
    }


@BENCHMARK.experiment("spacing", "Spacing")
def spacing(settings: Settings) -> str:
    rows = []
    for noise in (0.0, 0.005):
        targets = {"within 0.7 to 2 d, %": Target(95, 95, at_least=True)}
        rows += judged(settings, f"torus, {100 * noise:g} %", targets, spacing_figures, noise)
    return (
        f"`epsilon` {EPSILON:g}, spacing {SPACING_BOUNDS[0]:g} to {SPACING_BOUNDS[1]:g}, 20 000 points: middles of every fifth segment, "
        "either side, over d of the true curvature across.\n\n" + table(rows)
    )


def projection_figures(projection: str, seed: int) -> Figures:
    cloud = oriented("torus", 16000, 0.005, seed)
    lines = traced(*cloud, target_vertices=TARGET_VERTICES, projection=projection)
    # The two filters one after the other: only they let the projection be chosen.
    longer = run_filter(TRACE, *cloud, target_vertices=TARGET_VERTICES, projection=projection, stop_factor=0.5)
    diagonal = analytic_surfaces.surface("torus").diagonal
    return {
        "line points RMS, % of the diagonal": 100.0 * rms_distance("torus", lines.vertices) / diagonal,
        "quads, %": 100.0 * PolygonMesh.of(run_on(longer.meshes, MESH)).topology.quad_share,
        "tracing, s": lines.ran.report["seconds_tracing"],
    }


@BENCHMARK.experiment("projections", "Projections")
def projections(settings: Settings) -> str:
    outcomes = {name: over_seeds(name, settings.seeds, partial(projection_figures, name)) for name in PROJECTIONS}
    figures = outcomes[PROJECTIONS[0]].names()
    rows = [[name, *(number(outcome.median(figure)) for figure in figures)] for name, outcome in outcomes.items()]
    return (
        "Torus of 16 000 points, 0.5 % noise, medians; the mesh of lines traced with `stop_factor` 0.5.\n\n"
        + markdown_table(["projection", *figures], rows)
    )


@BENCHMARK.experiment("cow", "Epsilon")
def cow(settings: Settings) -> str:
    if settings.data is None or not found(settings.data, COW):
        return f"Left out: `--data FOLDER` says where {COW} is.\n"
    positions, normals = oriented_vertices(settings.data / COW)
    diagonal = float(np.linalg.norm(np.ptp(positions, axis=0)))
    estimated = run_filter(CURVATURE, positions, normals)
    across = np.abs([estimated.attribute(name) for name in ("curv_k2", "curv_k1")])
    least, most = COW_BOUNDS[0] * diagonal, COW_BOUNDS[1] * diagonal
    rows: list[list[str]] = []
    last = 0
    for epsilon in (1e-5, 1e-4, 1e-3, 1e-2):
        progress(f"cow, {epsilon:g}")
        lines = traced(positions, normals, epsilon=epsilon, min_spacing=least, max_spacing=most)
        counts = Counter(lines.family[np.unique(lines.line, return_index=True)[1]])
        met = int(lines.ran.report["crossings"])
        wanted = wanted_spacing(across, epsilon * diagonal)
        bounded = [f"{100 * float(np.mean(share)):.0f}" for share in (wanted < least, wanted > most)]
        factor = f"{last / max(met, 1):.1f}" if last else "–"
        rows.append(
            [f"{epsilon:g}", str(counts[1]), str(counts[2]), str(met), factor, *bounded, f"{lines.ran.seconds:.1f}"]
        )
        last = met
    header = [
        "epsilon",
        "lines of family 1",
        "of family 2",
        "crossings",
        "fewer by",
        "d below the bound, %",
        "above, %",
        "whole filter, s",
    ]
    return (
        f"{COW}, fig 11, spacing bounded to {COW_BOUNDS[0]:g} (a point spacing) and {COW_BOUNDS[1]:g} diagonals. d grows with the root "
        "of `epsilon`, so that crossings, the vertices of a mesh, fall tenfold a decade and lines about threefold where "
        "neither bound holds.\n\n" + markdown_table(header, rows)
    )


@BENCHMARK.introduction
def introduction(settings: Settings) -> str:
    return (
        f"Seeds 1 to {settings.seeds[-1]}; must and aim are judged by the **worst seed**. Normals are planes fitted to "
        f"{PLANE_FIT_NEIGHBORS} neighbours, their side the true one; noise is a fraction of the diagonal.\n"
    )


if __name__ == "__main__":
    main(BENCHMARK)
