# How near the sharp feature lines are to the true edges, how much of these they cover, and what they make up.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np

from clouds.generated import PLANE_FIT_NEIGHBORS, oriented
from clouds.scans import found, oriented_vertices
from clouds.true_curves import true_edges
from figures.mesh import distances
from harness.command_line import Benchmark, Settings, main
from harness.our_filters import Ran, run_filter
from harness.report import markdown_table, progress
from harness.shared import FEATURES, analytic_surfaces, rms

SHAPES = [("cube", 600), ("cube", 6000), ("cube", 60000), ("l_block", 6000), ("capped_cylinder", 6000)]
EDGES_AND_CORNERS = {"cube": (12, 8), "l_block": (18, 12), "capped_cylinder": (2, 0)}
SMOOTH = ["torus", "sphere", "ellipsoid", "helicoid", "capsule", "cylinder", "bent_sheet", "plane"]
SCANS = ["fandisk_clean.obj", "fandisk_noise0.3.obj"]  # the same vertices in the same order
ANGLES = ((20, 30), (30, 60), (60, 180))  # degrees: classes of edges of the fandisk
EDGE_POINTS = 5  # that stand for an edge of the fandisk

BENCHMARK = Benchmark("creases", "Sharp feature lines", data="the fandisk is")


def extracted(positions: np.ndarray, normals: np.ndarray) -> Ran:
    return run_filter(FEATURES, positions, normals)


def line_vertices(ran: Ran) -> np.ndarray:
    """V x 3; without curves the current layer is the cloud itself."""
    return ran.vertices if ran.report["curves"] else np.empty((0, 3))


@BENCHMARK.experiment("shapes", "Exact shapes")
def shapes(_: Settings) -> str:
    rows = []
    for surface, points in SHAPES:
        edges, diagonal = true_edges(surface), analytic_surfaces.surface(surface).diagonal
        curves, corners = EDGES_AND_CORNERS[surface]
        for noise in (0.0,) if points < 1000 else (0.0, 0.0025, 0.005):
            label = f"{surface} {points}, {100 * noise:g} %"
            progress(label)
            ran = extracted(*oriented(surface, points, noise, seed=1))
            vertices, report = line_vertices(ran), ran.report
            off, gaps = distances(vertices, edges) / diagonal, distances(edges, vertices) / diagonal
            rows.append(
                [
                    label,
                    f"{report['curves']} of {curves}, {report['corners']} of {corners}",
                    f"{100 * rms(off):.3f}",
                    f"{100 * off.max():.3f}",
                    f"{100 * gaps.max():.3f}",
                    f"{report['seconds_denoising']:.1f} + {report['seconds_creases']:.1f}",
                ]
            )
    header = [
        "cloud, noise",
        "curves, corners",
        "RMS, %",
        "largest, %",
        "largest gap, %",
        "seconds: denoising + creases",
    ]
    return markdown_table(header, rows)


@BENCHMARK.experiment("smooth", "Curves on smooth surfaces, where none is right")
def smooth(_: Settings) -> str:
    rows = []
    for surface in SMOOTH:
        progress(surface)
        clouds = (oriented(surface, 3000, noise, seed=1) for noise in (0.0, 0.005, 0.01, 0.02))
        rows.append([surface, *(str(extracted(*cloud).report["curves"]) for cloud in clouds)])
    return markdown_table(["3000 points", *(f"{percent} %" for percent in (0, 0.5, 1, 2))], rows)


def bent_edges(mesh: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points along the inner edges of an OBJ file (E x EDGE_POINTS x 3), and the angle in degrees of the faces there (E)."""
    lines = [line.split() for line in mesh.read_text().splitlines()]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=float)
    faces = np.array([[int(corner.split("/")[0]) - 1 for corner in line[1:4]] for line in lines if line[:1] == ["f"]])
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    sides = defaultdict(list)
    for face, corners in enumerate(faces):
        for k in range(3):
            sides[tuple(sorted((corners[k], corners[(k + 1) % 3])))].append(face)
    inner = [(edge, pair) for edge, pair in sides.items() if len(pair) == 2]
    cosines = [normals[pair[0]] @ normals[pair[1]] for _, pair in inner]
    t = np.linspace(0.0, 1.0, EDGE_POINTS)[:, None]
    along = np.array([vertices[edge[0]] + t * (vertices[edge[1]] - vertices[edge[0]]) for edge, _ in inner])
    return along, np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))


@BENCHMARK.experiment("fandisk", "Fandisk: edges of the clean mesh by the angle of its faces")
def fandisk(settings: Settings) -> str:
    data = settings.data
    if data is None or not found(data, *SCANS):
        return f"Left out: needs `--data FOLDER` with {' and '.join(SCANS)}.\n"
    edges, angle = bent_edges(data / SCANS[0])
    spacing = np.median(np.linalg.norm(edges[:, -1] - edges[:, 0], axis=1))
    rows = []
    for name in SCANS:
        progress(name)
        ran = extracted(*oriented_vertices(data / name))
        vertices = line_vertices(ran)
        covered = [
            np.mean(distances(edges[(angle >= low) & (angle < high)].reshape(-1, 3), vertices) < 1.5 * spacing)
            for low, high in ANGLES
        ]
        true = np.mean(distances(vertices, edges[angle > 15].reshape(-1, 3)) < spacing)
        shares = [f"{100 * share:.1f}" for share in (*covered, true)]
        rows.append([name, str(ran.report["curves"]), str(ran.report["corners"]), *shares])
    header = [
        "file",
        "curves",
        "corners",
        "20-30° covered, %",
        "30-60° covered, %",
        "over 60° covered, %",
        "vertices on true edges, %",
    ]
    return markdown_table(header, rows)


@BENCHMARK.introduction
def introduction(_: Settings) -> str:
    return (
        f"Default parameters, seed 1, normals of planes through {PLANE_FIT_NEIGHBORS} neighbours. Noise and distances are "
        "fractions of the surface's diagonal; the gap is the largest distance of a true edge from a vertex of a line. An "
        "edge of the fandisk is covered within 1.5 median edge lengths, a vertex right within one of an edge over 15°.\n"
    )


if __name__ == "__main__":
    main(BENCHMARK)
