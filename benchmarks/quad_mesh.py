# How right the whole pipeline's quad meshes are, and how fast they come, beside what we hold them to and beside the
# two-step routes a user has today on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from clouds.generated import PLANE_FIT_NEIGHBORS
from clouds.quad_mesh import SCANS, TARGET_VERTICES, Cloud, sampled, scanned
from clouds.scans import found
from figures.mesh import PolygonMesh, common_figures, edge_distances, mean_angle, rim_distance
from figures.topology import SPECK, Topology, topology_of_file
from harness.command_line import Benchmark, Settings, main
from harness.comparison import Case, Comparison, Figures
from harness.fresh_process import cost_of
from harness.our_filters import Ran, run_filter
from harness.report import markdown_table, progress
from harness.shared import PIPELINE, analytic_surfaces
from harness.verdicts import Target, verdict
from peers.quad_columns import DEPTHS, quad_columns
from peers.quad_routes import QUADS, poisson_then_quads

TIMED_RUNS = 2

BENCHMARK = Benchmark("quad_mesh", "Quad meshes", options=("quick", "peers", "seeds"), data="the scans are")


def our_run(cloud: Cloud) -> Ran:
    return run_filter(PIPELINE, cloud.positions, cloud.normals, target_vertices=cloud.target)


COMPARISON = Comparison(
    ours=lambda cloud: PolygonMesh.of(our_run(cloud)),
    peers=quad_columns,
    larger_is_better=lambda name: name.startswith(("quads", "valence")),
    every_seed=True,
)


def smooth_figures(cloud: Cloud, mesh: PolygonMesh) -> Figures:
    figures = common_figures(cloud.surface, cloud.target, mesh)
    if cloud.surface != "sphere":
        figures["mean angle, degrees"] = mean_angle(cloud.surface, mesh)
    if not analytic_surfaces.surface(cloud.surface).closed:
        figures["rim distance, %"] = rim_distance(cloud.surface, mesh)
    return figures


def cube_figures(cloud: Cloud, mesh: PolygonMesh) -> Figures:
    return common_figures(cloud.surface, cloud.target, mesh) | edge_distances(mesh)


RIGHT = {"wrong topology": Target(0.0, 0.0), "count off target, %": Target(5.0, 2.0)}


def shares(quads: tuple[float, float], valence: tuple[float, float]) -> dict[str, Target]:
    return {"quads, %": Target(*quads, at_least=True), "valence 4, %": Target(*valence, at_least=True)}


TORUS = RIGHT | shares((99.5, 100.0), (99.0, 100.0))
TORUS_AT = {
    0.0: {
        "mean angle, degrees": Target(0.3, 0.1),
        "mean distance, %": Target(0.05, 0.045),
        "vertices RMS, %": Target(0.005, 0.002),
        "Hausdorff, mesh to surface, %": Target(0.2, 0.12),
    },
    0.0025: {"mean angle, degrees": Target(0.6, 0.2), "vertices RMS, %": Target(0.04, 0.03)},
    0.005: {
        "mean angle, degrees": Target(0.8, 0.4),
        "mean distance, %": Target(0.08, 0.065),
        "vertices RMS, %": Target(0.07, 0.05),
    },
    0.01: {},
}


@BENCHMARK.experiment("closed", "Closed surfaces")
def closed(settings: Settings) -> str:
    cases = [
        Case(f"torus, {100 * noise:g} %", sampled("torus", 20000, noise), TORUS | more, quick=noise == 0.0025)
        for noise, more in TORUS_AT.items()
    ]
    ellipsoid = RIGHT | shares((98.5, 99.5), (98.0, 99.0)) | {"mean angle, degrees": Target(1.5, 0.8)}
    cases += [
        Case("ellipsoid, 0.25 %", sampled("ellipsoid", 20000, 0.0025), ellipsoid, quick=True),
        Case("sphere, 0.25 %", sampled("sphere", 20000, 0.0025), RIGHT | shares((97.0, 99.5), (96.0, 99.0))),
        Case("double torus, 0.25 %", sampled("double_torus", 20000, 0.0025), RIGHT, quick=True),
    ]
    return "20 000 points.\n\n" + COMPARISON.table(cases, settings, smooth_figures)


@BENCHMARK.experiment("open", "Open surfaces")
def open_surfaces(settings: Settings) -> str:
    targets = RIGHT | {"rim distance, %": Target(0.5, 0.2)}
    cases = [
        Case(
            f"{surface.replace('_', ' ')}, {100 * noise:g} %",
            sampled(surface, 20000, noise),
            targets,
            quick=noise > 0.0 and surface == "helicoid",
        )
        for surface in ("helicoid", "cylinder", "half_torus")
        for noise in (0.0, 0.0025)
    ]
    return "20 000 points.\n\n" + COMPARISON.table(cases, settings, smooth_figures)


@BENCHMARK.experiment("cube", "Cube")
def cube(settings: Settings) -> str:
    common = {"wrong topology": Target(0.0, 0.0), "quads, %": Target(98.0, 100.0, at_least=True)}
    edges = {
        0.0: {"edges RMS, %": Target(0.05, 0.01), "edges max, %": Target(0.2, 0.2)},
        0.0025: {"edges RMS, %": Target(0.15, 0.08), "edges max, %": Target(0.5, 0.5)},
    }
    cases = [
        Case(f"cube, {100 * noise:g} %", sampled("cube", 60000, noise), common | more, quick=noise > 0.0)
        for noise, more in edges.items()
    ]
    return "60 000 points; creases are found, not given.\n\n" + COMPARISON.table(cases, settings, cube_figures)


@BENCHMARK.experiment("small", "Small clouds")
def small(settings: Settings) -> str:
    targets = {"wrong topology": Target(0.0, 0.0), "quads, %": Target(95.0, 95.0, at_least=True)}
    smooth = [
        Case("torus 1600", sampled("torus", 1600), targets, quick=True),
        Case("helicoid 1730", sampled("helicoid", 1730), targets, quick=True),
    ]
    sharp = [Case("cube 600", sampled("cube", 600), targets, quick=True)]
    return (
        "The papers' sizes, without noise, the number of vertices the filter's own choice.\n\n"
        + COMPARISON.table(sharp, settings, cube_figures)
        + "\n"
        + COMPARISON.table(smooth, settings, smooth_figures)
    )


COUNTED = {"cow_loop2_46433_derived.ply", "bunny_oriented.ply", "armadillo.obj"}


def described(shape: Topology) -> str:
    return f"{shape.components} / {shape.euler_characteristic} / {shape.boundary_loops}"


@BENCHMARK.experiment("scans", "Real scans")
def scans(settings: Settings) -> str:
    data = settings.data
    if data is None:
        return "Skipped: `--data FOLDER` says where the scans are.\n"
    header = [
        "file", "points", "components / χ / rims", "of the file's faces", "dropped / holes filled",
        "non-manifold edges / vertices", "quads, %", "93 % met", "vertices / target", "5 %, 2 % met", "seconds",
    ]  # fmt: skip
    rows = []
    for scan in SCANS[:2] if settings.quick else SCANS:
        if not found(data, scan.file):
            rows.append([scan.file, "not there", *[""] * (len(header) - 2)])
            continue
        progress(scan.file)
        cloud = scanned(scan, data)
        truth = topology_of_file(data / (scan.truth or scan.file))
        ran = our_run(cloud)
        mesh = PolygonMesh.of(ran)
        shape, quads = mesh.topology, 100.0 * mesh.topology.quad_share
        off = 100.0 * abs(len(mesh.vertices) / scan.target - 1.0)
        rows.append(
            [
                scan.file,
                str(len(cloud.positions)),
                described(shape),
                described(truth) if truth else "–",
                f"{int(ran.report['dropped_components'])} / {int(ran.report['filled_holes'])}",
                f"{shape.nonmanifold_edges} / {shape.nonmanifold_vertices}",
                f"{quads:.1f}",
                verdict(quads, Target(93.0, 93.0, at_least=True))[2],
                f"{len(mesh.vertices)} / {scan.target}",
                verdict(off, Target(5.0, 2.0) if scan.file in COUNTED else None)[2],
                f"{ran.seconds:.1f}",
            ]
        )
    return (
        "Vertices and vertex normals of meshes as clouds. The file's own faces are those of its components with at least "
        f"{100.0 * SPECK:g} % of the faces, of the clean file where there is one; a rim shorter than a few edges of the "
        "mesh cannot be told from a gap in the sampling.\n\n" + markdown_table(header, rows)
    )


def time_row(label: str, cloud: Cloud, settings: Settings) -> list[str]:
    progress(f"time: {label}")
    cost = cost_of(PIPELINE, cloud.positions, cloud.normals, TIMED_RUNS, target_vertices=cloud.target)
    wall, processor = (1e-6 * len(cloud.positions) * share for share in (cost.wall, cost.processor))
    row = [label, f"{wall:.1f}", f"{processor:.1f}", f"{cost.megabytes:.0f}"]
    memory = verdict(cost.megabytes, Target(1024.0, 512.0))[2]
    if not settings.peers:
        return [*row, "–", "–", memory]
    routes = [poisson_then_quads(cloud.positions, cloud.normals, key, DEPTHS[0], cloud.target) for key in QUADS]
    fastest = min((mesh.seconds for mesh in routes if mesh), default=np.nan)
    cells = [f"{mesh.seconds:.1f} s, {mesh.megabytes:.0f} MB" if mesh else "crash" for mesh in routes]
    ratio = wall / fastest
    return [*row, f"{ratio:.2f}", verdict(ratio, Target(1.5, 1.0))[2], memory, *cells]


@BENCHMARK.experiment("time", "Time and memory")
def time_and_memory(settings: Settings) -> str:
    sizes = (20000,) if settings.quick else (20000, 200000)
    rows = [time_row(f"torus {points}, 0.25 %", sampled("torus", points, 0.0025)(1), settings) for points in sizes]
    header = [
        "cloud",
        "wall clock, s",
        "processor, s",
        "peak, MB",
        "over the fastest route",
        "1.5, 1 met",
        "1024, 512 MB met",
    ]
    if settings.peers:
        header += [f"Poisson {DEPTHS[0]} + {name}" for name in QUADS.values()]
    return (
        f"Seed 1, whole pipeline, fastest of {TIMED_RUNS} fresh processes, peers of one; where `processor` is well below "
        "the wall clock times the threads, the machine was busy with other work. Peak memory above the host with the "
        "cloud loaded.\n\n" + markdown_table(header, rows)
    )


@BENCHMARK.introduction
def introduction(settings: Settings) -> str:
    text = (
        f"`{PIPELINE}` with default parameters, `target_vertices` {TARGET_VERTICES} unless said otherwise. Ours: the median of "
        f"seeds 1 to {settings.seeds[-1]}; must and aim are judged by the **worst seed**. Input normals are "
        f"planes fitted to {PLANE_FIT_NEIGHBORS} neighbours, their side the true one. Noise and distances are fractions of "
        "the surface's diagonal. **Wrong topology**: 1 unless there is one manifold component of the right Euler "
        "characteristic with one loop per rim, counted here. **Valence 4**: share of the inner vertices. **Mean angle**: of "
        "the edges that do not lie on a rim to the nearer true principal direction at the foot of their middle. **Mean "
        "distance** and **Hausdorff**: of dense samples of the faces (quads cut along the shorter diagonal) to the exact "
        "surface, and of 20 000 surface points to the faces. **Rim distance**: the largest from the mesh's rim to the true "
        "one or back. **Edges**: of the cube's twelve edges from the nearest mesh edges.\n"
    )
    if settings.peers:
        text += (
            "\nPeers in the same run, at the same number of faces: PyMeshLab's screened Poisson reconstruction (depth; of open "
            "surfaces what lies further than four spacings from the points is cut off), then quads by PyPI's "
            "`pynanoinstantmeshes`, `pyQuadriFlow`, or by PyMeshLab (isotropic remeshing, smart triangle pairing). Best: of "
            "depths 6 and 8 and all three, picked for each figure with the truth in hand.\n"
        )
    return text


if __name__ == "__main__":
    main(BENCHMARK)
