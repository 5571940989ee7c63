# How near the sharp feature lines are to the true edges, how much of these they cover, and what they make up.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes benchmarks/results/creases.md. With names of experiments as arguments: only these, to the screen."""

from __future__ import annotations

import argparse
from collections import defaultdict
from pathlib import Path

import numpy as np

import measures
from measures import analytic_surfaces

PLANE_FIT_NEIGHBORS = 16
DENSITY = 4000  # points per unit length that stand for a true edge
SHAPES = [("cube", 600), ("cube", 6000), ("cube", 60000), ("l_block", 6000), ("capped_cylinder", 6000)]
EDGES_AND_CORNERS = {"cube": (12, 8), "l_block": (18, 12), "capped_cylinder": (2, 0)}
SMOOTH = ["torus", "sphere", "ellipsoid", "helicoid", "capsule", "cylinder", "bent_sheet", "plane"]
SCANS = ["fandisk_clean.obj", "fandisk_noise0.3.obj"]  # the same vertices in the same order


def segments(*ends: tuple[tuple[float, ...], tuple[float, ...]]) -> np.ndarray:
    parts = []
    for start, end in np.asarray(ends, dtype=float):
        t = np.linspace(0.0, 1.0, 2 + int(DENSITY * np.linalg.norm(end - start)))[:, None]
        parts.append(start + t * (end - start))
    return np.concatenate(parts)


def prism(outline: list[tuple[float, float]], half: float) -> np.ndarray:
    ends = []
    for a, b in zip(outline, outline[1:] + outline[:1], strict=True):
        ends += [((*a, z), (*b, z)) for z in (-half, half)] + [((*a, -half), (*a, half))]
    return segments(*ends)


def true_edges(surface: str) -> np.ndarray:
    """Points along all sharp edges."""
    if surface == "cube":
        return prism([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)], 0.5)
    if surface == "l_block":
        return prism([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.0), (0.0, 0.0), (0.0, 0.5), (-0.5, 0.5)], 0.25)
    angle = np.linspace(0.0, 2.0 * np.pi, int(np.pi * DENSITY))
    circle = 0.5 * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([np.column_stack([circle, np.full(len(angle), z)]) for z in (-0.5, 0.5)])


def nearest(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Distance of each point to the nearest of the others."""
    parts = np.array_split(points, max(1, len(points) * len(others) // 2_000_000))
    return np.concatenate([np.sqrt(((p[:, None] - others) ** 2).sum(axis=2).min(axis=1)) for p in parts])


def extract(positions: np.ndarray, normals: np.ndarray) -> tuple[dict, np.ndarray]:
    meshes = measures.layer(positions, normals)
    report = meshes.generate_sharp_feature_lines()
    return report, meshes.current_mesh().vertex_matrix() if report["curves"] else np.empty((0, 3))


def sampled(surface: str, points: int, noise: float) -> tuple[np.ndarray, np.ndarray]:
    cloud = analytic_surfaces.generate(surface, points, noise=noise, seed=1)
    return cloud["positions"], analytic_surfaces.plane_fit_normals(cloud["positions"], cloud["normals"], PLANE_FIT_NEIGHBORS)


def shapes(_: Path | None) -> str:
    rows = []
    for surface, points in SHAPES:
        edges, diagonal = true_edges(surface), analytic_surfaces.surface(surface).diagonal
        for noise in (0.0, 0.0025, 0.005):
            if points < 1000 and noise:
                continue
            report, vertices = extract(*sampled(surface, points, noise))
            off, gaps = nearest(vertices, edges) / diagonal, nearest(edges, vertices) / diagonal
            rows.append(
                [
                    f"{surface} {points}, {100 * noise:g} %",
                    f"{report['curves']} of {EDGES_AND_CORNERS[surface][0]}, {report['corners']} of {EDGES_AND_CORNERS[surface][1]}",
                    f"{100 * measures.rms(off):.3f}",
                    f"{100 * off.max():.3f}",
                    f"{100 * gaps.max():.3f}",
                    f"{report['seconds_denoising']:.1f} + {report['seconds_creases']:.1f}",
                ]
            )
    header = ["cloud, noise", "curves, corners", "RMS, %", "largest, %", "largest gap, %", "seconds: denoising + creases"]
    return measures.markdown_table(header, rows)


def smooth(_: Path | None) -> str:
    rows = []
    for surface in SMOOTH:
        counts = [extract(*sampled(surface, 3000, noise))[0]["curves"] for noise in (0.0, 0.005, 0.01, 0.02)]
        rows.append([surface, *map(str, counts)])
    return measures.markdown_table(["3000 points", *(f"{percent} %" for percent in (0, 0.5, 1, 2))], rows)


def bent_edges(mesh: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points along the edges of a mesh file and the angle (degrees) its faces make there."""
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
    t = np.linspace(0.0, 1.0, 5)[:, None]
    along = np.array([vertices[edge[0]] + t * (vertices[edge[1]] - vertices[edge[0]]) for edge, _ in inner])
    return along, np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))


def fandisk(data: Path | None) -> str:
    if data is None or not all((data / name).exists() for name in SCANS):
        return f"Left out: needs `--data FOLDER` with {' and '.join(SCANS)}.\n"
    edges, angle = bent_edges(data / SCANS[0])
    rows = []
    for name in SCANS:
        positions, normals = measures.oriented_vertices(data / name)
        report, vertices = extract(positions, normals)
        spacing = np.median(np.linalg.norm(edges[:, -1] - edges[:, 0], axis=1))
        covered = [
            np.mean(nearest(edges[(angle >= low) & (angle < high)].reshape(-1, 3), vertices) < 1.5 * spacing)
            for low, high in ((20, 30), (30, 60), (60, 180))
        ]
        true = np.mean(nearest(vertices, edges[angle > 15].reshape(-1, 3)) < spacing)
        rows.append([name, str(report["curves"]), str(report["corners"]), *(f"{100 * share:.1f}" for share in (*covered, true))])
    header = ["file", "curves", "corners", "20-30° covered, %", "30-60° covered, %", "over 60° covered, %", "vertices on true edges, %"]
    return measures.markdown_table(header, rows)


EXPERIMENTS = {
    "shapes": ("Exact shapes", shapes),
    "smooth": ("Curves on smooth surfaces, where none is right", smooth),
    "fandisk": ("Fandisk: edges of the clean mesh by the angle of its faces", fandisk),
}
INTRODUCTION = (
    f"Default parameters, seed 1, normals of planes through {PLANE_FIT_NEIGHBORS} neighbours. Noise and distances are "
    "fractions of the surface's diagonal; the gap is the largest distance of a true edge from a vertex of a line. An "
    "edge of the fandisk is covered within 1.5 median edge lengths, a vertex right within one of an edge over 15°.\n"
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help=", ".join(EXPERIMENTS))
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="where the fandisk is")
    given = parser.parse_args()
    for name in given.experiments:
        if name not in EXPERIMENTS:
            parser.error(f"no experiment is called {name}")
    sections = [INTRODUCTION]
    for name in given.experiments or EXPERIMENTS:
        title, run = EXPERIMENTS[name]
        sections.append(f"## {title}\n\n{run(given.data)}")
    if given.experiments:
        print("\n".join(sections))
    else:
        command = "creases.py" + (" --data FOLDER" if given.data else "")
        measures.write_result("creases", command, "Sharp feature lines", "\n".join(sections))


if __name__ == "__main__":
    main()
