# How far points are from an exact surface, and how far edges turn from its principal directions.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from harness.shared import analytic_surfaces, axis_angle, rms


def distance_to_surface(surface: str, points: np.ndarray) -> np.ndarray:
    """Of every point (N x 3) to its foot point, in the unit of the points."""
    return np.linalg.norm(points - analytic_surfaces.project(surface, points)["foot_points"], axis=1)


def rms_distance(surface: str, points: np.ndarray) -> float:
    return rms(distance_to_surface(surface, points))


def largest_in_percent(surface: str, distances: np.ndarray) -> float:
    """The largest of some distances, in percent of the surface's diagonal."""
    return 100.0 * float(distances.max()) / analytic_surfaces.surface(surface).diagonal


def along_surface(segments: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Segments (N x 3) without their part along the normals."""
    return segments - np.einsum("ij,ij->i", segments, normals)[:, None] * normals


def mean_angle_to_principal_directions(surface: str, vertices: np.ndarray, ends: np.ndarray) -> float:
    """Degrees between mesh edges (pairs of vertices) and the nearer principal direction at the foot of their middle."""
    first, second = vertices[ends[:, 0]], vertices[ends[:, 1]]
    truth = analytic_surfaces.project(surface, 0.5 * (first + second))
    edges = along_surface(second - first, truth["normals"])
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    nearer = np.minimum(axis_angle(edges, truth["d1"]), axis_angle(edges, truth["d2"]))
    return float(np.degrees(nearer.mean()))
