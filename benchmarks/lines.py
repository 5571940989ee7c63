# Traced lines of curvature (A09 sections 5.1 and 5.2) as numbers: where they lie, where they run, how far apart, and
# the mesh between them.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/lines.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import sys
import time
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from statistics import median

import numpy as np

import experiments
import measures
from comparison import Target, number, verdict
from experiments import Settings
from measures import analytic_surfaces
from mesh_figures import PolygonMesh, along, distances, topology_is_right

TRACE = "generate_curvature_lines"
PIPELINE = "generate_surface_reconstruction_curvature_aligned"
PROJECTIONS = ("Mixed", "Locally Optimal", "Weighted Average")
COW = "cow_loop2_46433_derived.ply"
COW_BOUNDS = 0.003, 0.5  # of the diagonal
PLANE_FIT_NEIGHBORS = 16
TARGET_VERTICES = 1600
UMBILIC = 0.1  # of the largest |k1 - k2|: where the true directions mean something
STRAY = 2.0  # point spacings from the nearest point: a line has left the cloud, or is in a void of it
VOID = 1.0  # point spacings from the surface, which ends at its rim: within that it is a void
UMBILICAL = "sphere", "cube"  # k1 = k2 everywhere: every tangent is a principal direction
SAMPLES = 5  # of a segment, when the distance to it is asked for


@dataclass(frozen=True)
class Lines:
    vertices: np.ndarray
    normals: np.ndarray
    edges: np.ndarray
    line: np.ndarray  # per vertex
    family: np.ndarray  # per vertex
    report: dict[str, float]
    seconds: float

    @cached_property
    def ends(self) -> np.ndarray:
        """E x 2 x 3."""
        return self.vertices[self.edges]

    @cached_property
    def middles(self) -> np.ndarray:
        return self.ends.mean(axis=1)


def cloud(surface: str, points: int, noise: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    made = analytic_surfaces.generate(surface, points, noise=noise, seed=seed)
    return made["positions"], analytic_surfaces.plane_fit_normals(
        made["positions"], made["normals"], PLANE_FIT_NEIGHBORS
    )


def traced(positions: np.ndarray, normals: np.ndarray, **parameters) -> Lines:
    meshes = measures.layer(positions, normals)
    start = time.perf_counter()
    report = meshes.apply_filter(TRACE, **parameters)
    seconds = time.perf_counter() - start
    mesh = meshes.current_mesh()
    line, family = (
        np.rint(mesh.vertex_custom_scalar_attribute_array(name)).astype(int) for name in ("line_id", "line_family")
    )
    return Lines(
        mesh.vertex_matrix(), mesh.vertex_normal_matrix(), mesh.edge_matrix(), line, family, report, seconds
    )


def meshed(positions: np.ndarray, normals: np.ndarray) -> PolygonMesh:
    meshes = measures.layer(positions, normals)
    report = meshes.apply_filter(PIPELINE, method="Traced Lines", target_vertices=TARGET_VERTICES)
    mesh = meshes.current_mesh()
    return PolygonMesh(mesh.vertex_matrix(), mesh.polygonal_face_list(), report)


def mesh_of_lines(positions: np.ndarray, normals: np.ndarray, **parameters) -> PolygonMesh:
    """The two filters one after the other: only they let the projection be chosen."""
    meshes = measures.layer(positions, normals)
    meshes.apply_filter(TRACE, target_vertices=TARGET_VERTICES, **parameters)
    report = meshes.apply_filter("generate_curvature_aligned_quad_mesh")
    mesh = meshes.current_mesh()
    return PolygonMesh(mesh.vertex_matrix(), mesh.polygonal_face_list(), report)


def row(label: str, values: list[float], target: Target | None = None) -> list[str]:
    """Median and worst of the seeds; judged by the worst."""
    worst = min(values) if target and target.at_least else max(values)
    return [label, number(median(values)), number(worst), *verdict(worst, target)]


def table(rows: list[list[str]]) -> str:
    return measures.markdown_table(["figure", "median", "worst seed", "must", "aim", "met"], rows)


def progress(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def mesh(settings: Settings) -> str:
    rows = []
    for noise, quads in ((0.0, 95.0), (0.005, 92.0)):
        found = []
        for seed in settings.seeds:
            progress(f"mesh, {100 * noise:g} %, seed {seed}")
            found.append(meshed(*cloud("torus", 20000, noise, seed)))
        label = f"torus, {100 * noise:g} %: "
        rows += [
            row(label + "wrong topology", [float(not topology_is_right("torus", m)) for m in found], Target(0, 0)),
            row(label + "quads, %", [100 * m.topology.quad_share for m in found], Target(quads, 98, at_least=True)),
            row(label + "components", [float(m.topology.components) for m in found]),
            row(label + "rims", [float(m.topology.boundary_loops) for m in found]),
            row(label + "Euler characteristic", [float(m.topology.euler_characteristic) for m in found]),
            row(label + "vertices", [float(len(m.vertices)) for m in found]),
        ]
    return f"*Traced Lines*, 20 000 points, `target_vertices` {TARGET_VERTICES}.\n\n" + table(rows)


def noise_removed(settings: Settings) -> str:
    rows = []
    for noise, must in ((0.005, 75.0), (0.01, 80.0)):
        removed = []
        for seed in settings.seeds:
            progress(f"noise, {100 * noise:g} %, seed {seed}")
            positions, normals = cloud("torus", 16000, noise, seed)
            lines = traced(positions, normals, target_vertices=TARGET_VERTICES)
            before, after = (
                measures.rms(measures.distance_to_surface("torus", p)) for p in (positions, lines.vertices)
            )
            removed.append(100.0 * (1.0 - after / before))
        rows.append(row(f"torus, {100 * noise:g} %: noise removed, %", removed, Target(must, 88.0, at_least=True)))
    return "RMS distance to the surface: 1 − line points / cloud points. 16 000 points.\n\n" + table(rows)


def angles(surface: str, lines: Lines) -> np.ndarray:
    """Degrees between segments and the true direction of their own family, away from umbilics."""
    truth = analytic_surfaces.project(surface, lines.middles)
    segment = lines.ends[:, 1] - lines.ends[:, 0]
    segment -= np.einsum("ij,ij->i", segment, truth["normals"])[:, None] * truth["normals"]
    lengths = np.linalg.norm(segment, axis=1)
    gap = np.abs(truth["k1"] - truth["k2"])
    judged = (lengths > 1e-9) & (gap > UMBILIC * gap.max())
    first = (lines.family[lines.edges[:, 0]] == 1)[:, None]
    # Not the nearer of both: that would hide a swapped family.
    wanted = np.where(first, truth["d1"], truth["d2"])
    return np.degrees(
        measures.angle_between_lines(segment[judged] / lengths[judged, None], wanted[judged])
    )


def tilts(surface: str, lines: Lines, spacing: float) -> np.ndarray:
    """Degrees between segments and the true tangent plane, a point spacing or more from edges."""
    truth = analytic_surfaces.project(surface, lines.middles)
    segment = lines.ends[:, 1] - lines.ends[:, 0]
    lengths = np.linalg.norm(segment, axis=1)
    judged = (lengths > 1e-9) & (truth["feature_distance"] > spacing)
    rise = np.einsum("ij,ij->i", segment[judged], truth["normals"][judged]) / lengths[judged]
    return np.degrees(np.arcsin(np.clip(np.abs(rise), 0.0, 1.0)))


def directions(settings: Settings) -> str:
    rows = []
    for surface in ("torus", "ellipsoid", "helicoid", "cylinder", "capsule", *UMBILICAL):
        for noise, target in ((0.0, Target(0.3, 0.1)), (0.005, Target(2.0, 1.0))):
            means = []
            for seed in settings.seeds:
                progress(f"angle, {surface}, {100 * noise:g} %, seed {seed}")
                positions, normals = cloud(surface, 10000, noise, seed)
                lines = traced(positions, normals, target_vertices=TARGET_VERTICES)
                spacing = 2.0 * nearest_spacing(positions)
                found = tilts(surface, lines, spacing) if surface in UMBILICAL else angles(surface, lines)
                means.append(float(found.mean()))
            rows.append(row(f"{surface}, {100 * noise:g} %: mean angle, degrees", means, target))
    return (
        f"10 000 points. Away from umbilics: |k1 − k2| above {100 * UMBILIC:g} % of its largest value. The capsule is the mixed "
        "umbilical surface of fig 8, umbilical at its caps and judged between them. On sphere and cube every "
        "tangent is a principal direction: the angle is that to the tangent plane, on the cube a point spacing and "
        "more from its edges.\n\n" + table(rows)
    )


def convergence(settings: Settings) -> str:
    sizes = (1000, 2000, 4000, 8000, 16000)
    errors = np.empty((len(settings.seeds), len(sizes)))
    for i, seed in enumerate(settings.seeds):
        progress(f"convergence, seed {seed}")
        for j, size in enumerate(sizes):
            lines = traced(*cloud("torus", size, 0.0, seed), target_vertices=400)
            errors[i, j] = measures.rms(measures.distance_to_surface("torus", lines.vertices))
    slopes = [float(np.polyfit(-0.5 * np.log(sizes), np.log(line), 1)[0]) for line in errors]
    rows = [row("slope of log RMS against log spacing", slopes, Target(1.8, 2.5, at_least=True))]
    rows += [row(f"RMS, {size} points", list(errors[:, j])) for j, size in enumerate(sizes)]
    return "Torus without noise.\n\n" + table(rows)


def near_pairs(points: np.ndarray, reach: float) -> np.ndarray:
    """Pairs i < j nearer than reach along every axis, by a grid of that width."""
    cells: dict[tuple, list[int]] = {}
    keys = np.floor(points / reach).astype(int)
    for i, key in enumerate(map(tuple, keys)):
        cells.setdefault(key, []).append(i)
    found = []
    for (x, y, z), here in cells.items():
        around = [
            j
            for dx in (-1, 0, 1)
            for dy in (-1, 0, 1)
            for dz in (-1, 0, 1)
            for j in cells.get((x + dx, y + dy, z + dz), ())
        ]
        a, b = np.meshgrid(here, around, indexing="ij")
        close = (a < b) & (np.abs(points[a] - points[b]).max(axis=2) < reach)
        found.append(np.stack([a[close], b[close]], axis=1))
    return np.vstack(found)


def crossings(lines: Lines) -> tuple[int, int]:
    """Crossings of different lines of one family, and of lines with themselves, in the plane of the normals there."""
    vectors = lines.ends[:, 1] - lines.ends[:, 0]
    lengths = np.linalg.norm(vectors, axis=1)
    pairs = near_pairs(lines.middles, 1.01 * float(lengths.max()))
    a, b = pairs[:, 0], pairs[:, 1]
    shared = (lines.edges[a][:, :, None] == lines.edges[b][:, None, :]).any(axis=(1, 2))
    same = lines.family[lines.edges[a, 0]] == lines.family[lines.edges[b, 0]]
    a, b = a[same & ~shared], b[same & ~shared]
    normal = lines.normals[lines.edges[a, 0]]
    facing = np.einsum("ij,ij->i", normal, lines.normals[lines.edges[b, 0]]) > 0.0
    a, b, normal = a[facing], b[facing], normal[facing]

    def side(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.einsum("ij,ij->i", np.cross(u, v), normal)

    def parted(i: np.ndarray, j: np.ndarray) -> np.ndarray:
        """Ends of segments j on both sides of the straight lines through segments i."""
        start = lines.ends[i, 0]
        return side(vectors[i], lines.ends[j, 0] - start) * side(vectors[i], lines.ends[j, 1] - start) < 0.0

    crossed = parted(a, b) & parted(b, a)
    own = lines.line[lines.edges[a, 0]] == lines.line[lines.edges[b, 0]]
    return int((crossed & ~own).sum()), int((crossed & own).sum())


def mistakes(settings: Settings) -> str:
    rows = []
    for surface in ("torus", "ellipsoid", "helicoid"):
        for noise in (0.0, 0.005):
            for method, kind in (("Traced Lines", ""), ("Position Field", ", position field")):
                found: dict[str, list[float]] = {}
                for seed in settings.seeds:
                    progress(f"mistakes, {surface}, {100 * noise:g} %, {method}, seed {seed}")
                    positions, normals = cloud(surface, 10000, noise, seed)
                    lines = traced(positions, normals, target_vertices=TARGET_VERTICES, method=method)
                    spacing = 2.0 * nearest_spacing(positions)

                    def count(mask: np.ndarray) -> int:
                        return len(set(lines.line[mask]))

                    others, own = crossings(lines)
                    far = distances(lines.vertices, positions) > STRAY * spacing
                    off = measures.distance_to_surface(surface, lines.vertices) > VOID * spacing
                    for name, value in (
                        ("same-family crossings", others),
                        ("self-crossings", own),
                        ("lines astray", count(far & off)),
                        ("lines across voids", count(far & ~off)),
                    ):
                        found.setdefault(name, []).append(float(value))
                for name, values in found.items():
                    target = None if name == "lines across voids" else Target(0, 0)
                    rows.append(row(f"{surface}{kind}, {100 * noise:g} %: {name}", values, target))
    return (
        f"10 000 points. Astray: further than {STRAY:g} point spacings (twice the median distance between nearest "
        f"neighbours) from the nearest point and {VOID:g} from the surface, which ends at its rim. Nearer to the surface it is a void "
        "of the cloud: random ones of this size have a few, and lines have to cross them.\n\n"
        + table(rows)
    )


def nearest_spacing(positions: np.ndarray) -> float:
    some = positions[:: max(1, len(positions) // 500)]
    return float(np.median([np.partition(np.linalg.norm(positions - p, axis=1), 1)[1] for p in some]))


def gaps(lines: Lines, wanted: np.ndarray) -> np.ndarray:
    """Distance from segment middles to the nearest line of their family on either side, over what was asked for."""
    family, line = (values[lines.edges[:, 0]] for values in (lines.family, lines.line))
    dense = along(lines.ends, SAMPLES)
    dense_line, dense_family = np.repeat(line, SAMPLES), np.repeat(family, SAMPLES)
    found = []
    for e in range(0, len(lines.edges), 5):
        forward = lines.ends[e, 1] - lines.ends[e, 0]
        length = np.linalg.norm(forward)
        if length == 0.0:
            continue
        across = np.cross(lines.normals[lines.edges[e, 0]], forward / length)
        offset = dense[(dense_family == family[e]) & (dense_line != line[e])] - lines.middles[e]
        aside = offset @ across
        # Beside, not ahead of a line's end.
        beside = (np.abs(offset @ (forward / length)) < 0.25 * wanted[e]) & (np.linalg.norm(offset, axis=1) < 4.0 * wanted[e])
        for side in (1.0, -1.0):
            there = beside & (side * aside > 0.0)
            found.append(np.linalg.norm(offset[there], axis=1).min() / wanted[e] if there.any() else 4.0)
    return np.array(found)


def spacing(settings: Settings) -> str:
    diagonal, epsilon = analytic_surfaces.surface("torus").diagonal, 0.0005
    bounds = 0.03, 0.3
    rows = []
    for noise in (0.0, 0.005):
        within, near = [], []
        for seed in settings.seeds:
            progress(f"spacing, {100 * noise:g} %, seed {seed}")
            lines = traced(
                *cloud("torus", 20000, noise, seed), epsilon=epsilon, min_spacing=bounds[0], max_spacing=bounds[1]
            )
            truth = analytic_surfaces.project("torus", lines.middles)
            first = lines.family[lines.edges[:, 0]] == 1
            k = np.abs(np.where(first, truth["k2"], truth["k1"]))  # across
            eps = epsilon * diagonal
            wanted = np.clip(2.0 * np.sqrt(eps * np.maximum(2.0 / np.maximum(k, 1e-9) - eps, 0.0)), *bounds)
            ratio = gaps(lines, wanted)
            within.append(100.0 * float(np.mean((ratio >= 0.7) & (ratio <= 2.0))))
            near.append(100.0 * float(np.mean(ratio < 0.7)))
        label = f"torus, {100 * noise:g} %: "
        rows += [row(label + "within 0.7 to 2 d, %", within, Target(95, 95, at_least=True)), row(label + "below 0.7 d, %", near)]
    return (
        f"`epsilon` {epsilon:g}, spacing {bounds[0]:g} to {bounds[1]:g}, 20 000 points: middles of every fifth segment, "
        "either side, over d of the true curvature across.\n\n" + table(rows)
    )


def projections(settings: Settings) -> str:
    rows = []
    for projection in PROJECTIONS:
        error, quads, seconds = [], [], []
        for seed in settings.seeds:
            progress(f"{projection}, seed {seed}")
            given = cloud("torus", 16000, 0.005, seed)
            lines = traced(*given, target_vertices=TARGET_VERTICES, projection=projection)
            diagonal = analytic_surfaces.surface("torus").diagonal
            error.append(100.0 * measures.rms(measures.distance_to_surface("torus", lines.vertices)) / diagonal)
            seconds.append(lines.report["seconds_tracing"])
            quads.append(100.0 * mesh_of_lines(*given, projection=projection, stop_factor=0.5).topology.quad_share)
        rows.append([projection, *(number(median(values)) for values in (error, quads, seconds))])
    return "Torus of 16 000 points, 0.5 % noise, medians; the mesh of lines traced with `stop_factor` 0.5.\n\n" + measures.markdown_table(
        ["projection", "line points RMS, % of the diagonal", "quads, %", "tracing, s"], rows
    )


def cow(settings: Settings) -> str:
    if settings.data is None or not (settings.data / COW).exists():
        return f"Left out: `--data FOLDER` says where {COW} is.\n"
    positions, normals = measures.oriented_vertices(settings.data / COW)
    diagonal = float(np.linalg.norm(np.ptp(positions, axis=0)))
    meshes = measures.layer(positions, normals)
    meshes.compute_curvature_robust_per_vertex()
    across = np.abs([meshes.current_mesh().vertex_custom_scalar_attribute_array(f"curv_k{f}") for f in (2, 1)])
    least, most = COW_BOUNDS[0] * diagonal, COW_BOUNDS[1] * diagonal
    rows, last = [], None
    for epsilon in (1e-5, 1e-4, 1e-3, 1e-2):
        progress(f"cow, {epsilon:g}")
        lines = traced(positions, normals, epsilon=epsilon, min_spacing=least, max_spacing=most)
        counts = Counter(lines.family[np.unique(lines.line, return_index=True)[1]])
        crossings = int(lines.report["crossings"])
        eps = epsilon * diagonal
        wanted = 2.0 * np.sqrt(eps * np.maximum(2.0 / np.maximum(across, 1e-12) - eps, 0.0))
        bounded = [f"{100 * float(np.mean(share)):.0f}" for share in (wanted < least, wanted > most)]
        factor = f"{last / max(crossings, 1):.1f}" if last else "–"
        rows.append([f"{epsilon:g}", str(counts[1]), str(counts[2]), str(crossings), factor, *bounded, f"{lines.seconds:.1f}"])
        last = crossings
    return (
        f"{COW}, fig 11, spacing bounded to {COW_BOUNDS[0]:g} (a point spacing) and {COW_BOUNDS[1]:g} diagonals. d grows with the root "
        "of `epsilon`, so that crossings, the vertices of a mesh, fall tenfold a decade and lines about threefold where "
        "neither bound holds.\n\n"
        + measures.markdown_table(
            ["epsilon", "lines of family 1", "of family 2", "crossings", "fewer by", "d below the bound, %", "above, %", "whole filter, s"],
            rows,
        )
    )


EXPERIMENTS = {
    "mesh": ("The mesh between the lines", mesh),
    "noise": ("Noise removed", noise_removed),
    "directions": ("Angle to the true directions", directions),
    "convergence": ("Convergence", convergence),
    "mistakes": ("Crossings and lines that leave the cloud", mistakes),
    "spacing": ("Spacing", spacing),
    "projections": ("Projections", projections),
    "cow": ("Epsilon", cow),
}


def main() -> None:
    parser = experiments.parser_of(EXPERIMENTS, __doc__, f"where {COW} is")
    parser.add_argument("--seeds", type=int, default=5, metavar="N", help="seeds 1 to N of every cloud (default: 5)")
    given = experiments.parse(parser, EXPERIMENTS)
    settings = Settings(given.quick, False, given.data, max(1, given.seeds))
    introduction = (
        f"Seeds 1 to {settings.seeds[-1]}; must and aim are judged by the **worst seed**. Normals are planes fitted to "
        f"{PLANE_FIT_NEIGHBORS} neighbours, their side the true one; noise is a fraction of the diagonal.\n"
    )
    further = f" --seeds {given.seeds}" if given.seeds != 5 else ""
    experiments.report("lines", "Traced lines of curvature", introduction, EXPERIMENTS, settings, given, further)


if __name__ == "__main__":
    main()
