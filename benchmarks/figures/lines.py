# Traced lines of curvature beside the truth: where they lie, where they run, what they cross and how far apart they are.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from clouds.true_curves import along
from figures.surface import along_surface
from harness.our_filters import Ran, run_filter
from harness.shared import TRACE, analytic_surfaces, axis_angle

UMBILIC = 0.1  # of the largest |k1 - k2|: where the true directions mean something
SAMPLES = 5  # points of a segment, when the distance to it is asked for
JUDGED_SEGMENTS = 5  # one in that many, where every one of them is compared with all others
FLAT = 1e-9  # curvature, per unit length: the least that a spacing is asked for
NO_NEIGHBOR = 4.0  # wanted distances: nothing is looked for beyond


@dataclass(frozen=True)
class Lines:
    vertices: np.ndarray  # N x 3
    normals: np.ndarray  # N x 3
    edges: np.ndarray  # E x 2
    line: np.ndarray  # N: number of the line
    family: np.ndarray  # N: 1 along d1, 2 along d2
    ran: Ran

    @cached_property
    def ends(self) -> np.ndarray:
        """E x 2 x 3."""
        return self.vertices[self.edges]

    @cached_property
    def middles(self) -> np.ndarray:
        """E x 3."""
        return self.ends.mean(axis=1)

    @cached_property
    def in_first_family(self) -> np.ndarray:
        """Mask of edges."""
        return self.family[self.edges[:, 0]] == 1


def traced(positions: np.ndarray, normals: np.ndarray, **parameters: object) -> Lines:
    ran = run_filter(TRACE, positions, normals, **parameters)
    line, family = (np.rint(ran.attribute(name)).astype(int) for name in ("line_id", "line_family"))
    return Lines(ran.vertices, ran.normals, ran.edges, line, family, ran)


def angles(surface: str, lines: Lines) -> np.ndarray:
    """Degrees between segments and the true direction of their own family, away from umbilics."""
    truth = analytic_surfaces.project(surface, lines.middles)
    segment = along_surface(lines.ends[:, 1] - lines.ends[:, 0], truth["normals"])
    lengths = np.linalg.norm(segment, axis=1)
    gap = np.abs(truth["k1"] - truth["k2"])
    judged = (lengths > 1e-9) & (gap > UMBILIC * gap.max())
    # Not the nearer of both: that would hide a swapped family.
    wanted = np.where(lines.in_first_family[:, None], truth["d1"], truth["d2"])
    return np.degrees(axis_angle(segment[judged] / lengths[judged, None], wanted[judged]))


def tilts(surface: str, lines: Lines, spacing: float) -> np.ndarray:
    """Degrees between segments and the true tangent plane, a point spacing or more from edges."""
    truth = analytic_surfaces.project(surface, lines.middles)
    segment = lines.ends[:, 1] - lines.ends[:, 0]
    lengths = np.linalg.norm(segment, axis=1)
    judged = (lengths > 1e-9) & (truth["feature_distance"] > spacing)
    rise = np.einsum("ij,ij->i", segment[judged], truth["normals"][judged]) / lengths[judged]
    return np.degrees(np.arcsin(np.clip(np.abs(rise), 0.0, 1.0)))


def near_pairs(points: np.ndarray, reach: float) -> np.ndarray:
    """Pairs i < j (P x 2) nearer than reach along every axis, by a grid of that width."""
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
        """Whether the ends of segments j are on both sides of the straight lines through segments i."""
        start = lines.ends[i, 0]
        return side(vectors[i], lines.ends[j, 0] - start) * side(vectors[i], lines.ends[j, 1] - start) < 0.0

    crossed = parted(a, b) & parted(b, a)
    own = lines.line[lines.edges[a, 0]] == lines.line[lines.edges[b, 0]]
    return int((crossed & ~own).sum()), int((crossed & own).sum())


def wanted_spacing(curvature: np.ndarray, error: float) -> np.ndarray:
    """Distance of lines at which a chord across that curvature (1 / length) misses the surface by ``error`` (A09, 5.1)."""
    return 2.0 * np.sqrt(error * np.maximum(2.0 / np.maximum(curvature, FLAT) - error, 0.0))


def gaps(lines: Lines, wanted: np.ndarray) -> np.ndarray:
    """Distance from middles of segments to the nearest line of their family on either side, over the wanted one (E)."""
    family, line = (values[lines.edges[:, 0]] for values in (lines.family, lines.line))
    dense = along(lines.ends, SAMPLES)
    dense_line, dense_family = np.repeat(line, SAMPLES), np.repeat(family, SAMPLES)
    found = []
    for e in range(0, len(lines.edges), JUDGED_SEGMENTS):
        forward = lines.ends[e, 1] - lines.ends[e, 0]
        length = np.linalg.norm(forward)
        if length == 0.0:
            continue
        across = np.cross(lines.normals[lines.edges[e, 0]], forward / length)
        offset = dense[(dense_family == family[e]) & (dense_line != line[e])] - lines.middles[e]
        aside = offset @ across
        # Beside, not ahead of a line's end.
        ahead = np.abs(offset @ (forward / length)) >= 0.25 * wanted[e]
        beside = ~ahead & (np.linalg.norm(offset, axis=1) < NO_NEIGHBOR * wanted[e])
        for side in (1.0, -1.0):
            there = beside & (side * aside > 0.0)
            nearest = np.linalg.norm(offset[there], axis=1).min() / wanted[e] if there.any() else NO_NEIGHBOR
            found.append(nearest)
    return np.array(found)
