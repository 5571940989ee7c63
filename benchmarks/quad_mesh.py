# How right the whole pipeline's quad meshes are, and how fast they come, beside what we hold them to and beside the
# two-step routes a user has today on the same clouds.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/quad_mesh.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import importlib.util
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pymeshlab

import comparison
import experiments
import measures
from comparison import Case, Column, Figures, Method, Target, one
from experiments import Settings
from fresh_process import cost_of
from measures import analytic_surfaces
from mesh_figures import PolygonMesh, common_figures, edge_distances, mean_angle, rim_distance
from peers.quad_routes import PACKAGES, QUADS, poisson_then_quads

PIPELINE = "generate_surface_reconstruction_curvature_aligned"
PLANE_FIT_NEIGHBORS = 16
TARGET_VERTICES = 1600  # of 20 000 points and more
TIMED_RUNS = 2


@dataclass(frozen=True)
class Cloud:
    surface: str
    positions: np.ndarray
    normals: np.ndarray
    target: int  # vertices; 0: the filter's own choice

    @property
    def spacing(self) -> float:
        """For the peers, of an open surface; 0 of a closed one. Its area from the points themselves."""
        if analytic_surfaces.surface(self.surface).closed:
            return 0.0
        area = {"helicoid": 2.96 * np.pi, "cylinder": 2.0 * np.pi, "half_torus": 0.8 * np.pi**2}[self.surface]
        return float(np.sqrt(area / len(self.positions)))


def sampled(surface: str, points: int, noise: float = 0.0) -> Callable[[int], Cloud]:
    def make(seed: int) -> Cloud:
        made = analytic_surfaces.generate(surface, points, noise=noise, seed=seed)
        normals = analytic_surfaces.plane_fit_normals(made["positions"], made["normals"], PLANE_FIT_NEIGHBORS)
        return Cloud(surface, made["positions"], normals, TARGET_VERTICES if points >= 20000 else 0)

    return make


def our_mesh(cloud: Cloud) -> PolygonMesh:
    meshes = measures.layer(cloud.positions, cloud.normals)
    report = meshes.apply_filter(PIPELINE, target_vertices=cloud.target)
    mesh = meshes.current_mesh()
    return PolygonMesh(mesh.vertex_matrix(), mesh.polygonal_face_list(), report)


def route(quads: str, depth: int) -> Method:
    def run(cloud: Cloud) -> PolygonMesh | None:
        faces = cloud.target or TARGET_VERTICES // 4
        found = poisson_then_quads(cloud.positions, cloud.normals, quads, depth, faces, cloud.spacing)
        return None if found is None else PolygonMesh(found.vertices, found.faces)

    return run


def present(package: str) -> bool:
    return importlib.util.find_spec(package) is not None


def peers_of(settings: Settings) -> list[Column]:
    if not settings.peers:
        return []
    missing = [package for package in PACKAGES if not present(package)]
    if missing:
        sys.exit(f"the peers need packages: .venv/bin/python -m pip install {' '.join(missing)} (or --without-peers)")
    routes = {f"Poisson {depth} + {name}": route(key, depth) for depth in (8, 6) for key, name in QUADS.items()}
    first = "Poisson 8 + Instant Meshes", "Poisson 8 + QuadriFlow"
    return [*(one(title, routes[title]) for title in first), Column("best of all", routes)]


def compare(cases: list[Case], settings: Settings, figures: Callable[[Cloud, PolygonMesh], Figures]) -> str:
    return comparison.compare(
        [case for case in cases if case.quick or not settings.quick],
        settings.seeds,
        our_mesh,
        peers_of(settings),
        figures,
        lambda name: name.startswith(("quads", "valence")),
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
    return "20 000 points.\n\n" + compare(cases, settings, smooth_figures)


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
    return "20 000 points.\n\n" + compare(cases, settings, smooth_figures)


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
    return "60 000 points; creases are found, not given.\n\n" + compare(cases, settings, cube_figures)


def small(settings: Settings) -> str:
    targets = {"wrong topology": Target(0.0, 0.0), "quads, %": Target(95.0, 95.0, at_least=True)}
    smooth = [
        Case("torus 1600", sampled("torus", 1600), targets, quick=True),
        Case("helicoid 1730", sampled("helicoid", 1730), targets, quick=True),
    ]
    sharp = [Case("cube 600", sampled("cube", 600), targets, quick=True)]
    return (
        "The papers' sizes, without noise, the number of vertices the filter's own choice.\n\n"
        + compare(sharp, settings, cube_figures)
        + "\n"
        + compare(smooth, settings, smooth_figures)
    )


@dataclass(frozen=True)
class Scan:
    file: str
    target: int
    truth: str = ""  # the file with the faces to be compared with, if another one


SCANS = [
    Scan("cow_loop2_46433_derived.ply", 3000),
    Scan("bunny_oriented.ply", 3000),
    Scan("armadillo.obj", 3000),
    Scan("hand_closed.obj", 1000),
    Scan("fandisk_noise0.3.obj", 1000, "fandisk_clean.obj"),
    Scan("angel_rawscan.obj", 1500),
    Scan("tooth_pongo_DE.ply", 1000),
    Scan("tooth_pongo_EM.ply", 1000),
    Scan("meshlab_lato270_rawscan.ply", 3000),
]
COUNTED = {"cow_loop2_46433_derived.ply", "bunny_oriented.ply", "armadillo.obj"}
SPECK = 0.01  # of the vertices: smaller components of a scan's own mesh are not counted


def scanned(path: Path) -> tuple[np.ndarray, np.ndarray, measures.Topology | None]:
    """Points, normals, and what the file's own faces are without specks (none in a file of points)."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    if meshes.current_mesh().face_number() == 0:
        mesh = meshes.current_mesh()
        return mesh.vertex_matrix(), mesh.vertex_normal_matrix(), None
    positions, normals = measures.oriented_vertices(path)
    meshes.meshing_remove_unreferenced_vertices()
    least = max(3, int(SPECK * meshes.current_mesh().face_number()))
    meshes.meshing_remove_connected_component_by_face_number(mincomponentsize=least)
    return positions, normals, measures.topology(list(meshes.current_mesh().face_matrix()))


def described(shape: measures.Topology) -> str:
    return f"{shape.components} / {shape.euler_characteristic} / {shape.boundary_loops}"


def scans(settings: Settings) -> str:
    if settings.data is None:
        return "Skipped: `--data FOLDER` says where the scans are.\n"
    rows = []
    for scan in SCANS[:2] if settings.quick else SCANS:
        if not (settings.data / scan.file).exists():
            rows.append([scan.file, "not there", *[""] * 9])
            continue
        print(scan.file, file=sys.stderr)
        positions, normals, truth = scanned(settings.data / scan.file)
        if scan.truth:
            _, _, truth = scanned(settings.data / scan.truth)
        start = time.perf_counter()
        mesh = our_mesh(Cloud("", positions, normals, scan.target))
        seconds = time.perf_counter() - start
        shape, off = mesh.topology, 100.0 * abs(len(mesh.vertices) / scan.target - 1.0)
        rows.append(
            [
                scan.file,
                str(len(positions)),
                described(shape),
                described(truth) if truth else "–",
                f"{int(mesh.report['dropped_components'])} / {int(mesh.report['filled_holes'])}",
                f"{shape.nonmanifold_edges} / {shape.nonmanifold_vertices}",
                f"{100.0 * shape.quad_share:.1f}",
                comparison.verdict(100.0 * shape.quad_share, Target(93.0, 93.0, at_least=True))[2],
                f"{len(mesh.vertices)} / {scan.target}",
                comparison.verdict(off, Target(5.0, 2.0) if scan.file in COUNTED else None)[2],
                f"{seconds:.1f}",
            ]
        )
    header = [
        "file", "points", "components / χ / rims", "of the file's faces", "dropped / holes filled",
        "non-manifold edges / vertices", "quads, %", "93 % met", "vertices / target", "5 %, 2 % met", "seconds",
    ]  # fmt: skip
    return (
        "Vertices and vertex normals of meshes as clouds. The file's own faces are those of its components with at least "
        f"{100.0 * SPECK:g} % of the faces, of the clean file where there is one; a rim shorter than a few edges of the "
        "mesh cannot be told from a gap in the sampling.\n\n" + measures.markdown_table(header, rows)
    )


def time_and_memory(settings: Settings) -> str:
    rows = []
    for points in (20000,) if settings.quick else (20000, 200000):
        label = f"torus {points}, 0.25 %"
        print(f"time: {label}", file=sys.stderr)
        cloud = sampled("torus", points, 0.0025)(1)
        cost = min(
            cost_of(PIPELINE, cloud.positions, cloud.normals, {"target_vertices": cloud.target}) for _ in range(TIMED_RUNS)
        )
        wall, processor = (1e-6 * points * share for share in (cost.wall, cost.processor))
        row = [label, f"{wall:.1f}", f"{processor:.1f}", f"{cost.megabytes:.0f}"]
        memory = comparison.verdict(cost.megabytes, Target(1024.0, 512.0))
        if not settings.peers:
            rows.append([*row, "–", "–", memory[2]])
            continue
        found = {
            name: poisson_then_quads(cloud.positions, cloud.normals, key, 8, cloud.target)
            for key, name in QUADS.items()
        }
        fastest = min((mesh.seconds for mesh in found.values() if mesh), default=np.nan)
        cells = [f"{mesh.seconds:.1f} s, {mesh.megabytes:.0f} MB" if mesh else "crash" for mesh in found.values()]
        ratio = wall / fastest
        rows.append([*row, f"{ratio:.2f}", comparison.verdict(ratio, Target(1.5, 1.0))[2], memory[2], *cells])
    header = ["cloud", "wall clock, s", "processor, s", "peak, MB", "over the fastest route", "1.5, 1 met", "1024, 512 MB met"]
    if settings.peers:
        header += [f"Poisson 8 + {name}" for name in QUADS.values()]
    return (
        f"Seed 1, whole pipeline, fastest of {TIMED_RUNS} fresh processes, peers of one; where `processor` is well below "
        "the wall clock times the threads, the machine was busy with other work. Peak memory above the host with the "
        "cloud loaded.\n\n" + measures.markdown_table(header, rows)
    )


EXPERIMENTS = {
    "closed": ("Closed surfaces", closed),
    "open": ("Open surfaces", open_surfaces),
    "cube": ("Cube", cube),
    "small": ("Small clouds", small),
    "scans": ("Real scans", scans),
    "time": ("Time and memory", time_and_memory),
}


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


def main() -> None:
    parser = experiments.parser_of(EXPERIMENTS, __doc__, "where the scans are")
    parser.add_argument("--seeds", type=int, default=5, metavar="N", help="seeds 1 to N of every cloud (default: 5)")
    given = experiments.parse(parser, EXPERIMENTS)
    settings = Settings(given.quick, not given.without_peers, given.data, max(1, given.seeds))
    further = f" --seeds {given.seeds}" if given.seeds != 5 else ""
    experiments.report("quad_mesh", "Quad meshes", introduction(settings), EXPERIMENTS, settings, given, further)


if __name__ == "__main__":
    main()
