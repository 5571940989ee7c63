# The true sharp edges and rims of the exact surfaces in sample_data/, as points along them.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

# Points per unit length.
EDGE_DENSITY = 4000
CURVE_DENSITY = 500  # where every point costs a search in a mesh

Outline = list[tuple[float, float]]  # corners of a polygon in the plane

SQUARE: Outline = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
PRISMS: dict[str, tuple[Outline, float]] = {  # of the surfaces that are prisms: outline, half height
    "cube": (SQUARE, 0.5),
    "l_block": ([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.0), (0.0, 0.0), (0.0, 0.5), (-0.5, 0.5)], 0.25),
}
RIM_RADII = {"cylinder": 0.5, "half_torus": 0.4}


def along(ends: np.ndarray, count: int) -> np.ndarray:
    """As many points (x 3) along each of some segments (N x 2 x 3), ends among them."""
    t = np.linspace(0.0, 1.0, count)[None, :, None]
    return (ends[:, None, 0] + t * (ends[:, None, 1] - ends[:, None, 0])).reshape(-1, 3)


def circle(radius: float, center: tuple[float, float, float], u: tuple, v: tuple, count: int) -> np.ndarray:
    """As many points (x 3) around a center, in the plane of the unit vectors u and v; the last is the first again."""
    angles = np.linspace(0.0, 2.0 * np.pi, count)[:, None]
    return np.array(center) + radius * (np.cos(angles) * np.array(u, float) + np.sin(angles) * np.array(v, float))


def prism_edges(surface: str) -> np.ndarray:
    """Ends of the edges (E x 2 x 3)."""
    outline, half = PRISMS[surface]
    ends: list[tuple[tuple[float, ...], tuple[float, ...]]] = []
    for a, b in zip(outline, outline[1:] + outline[:1], strict=True):
        ends += [((*a, z), (*b, z)) for z in (-half, half)] + [((*a, -half), (*a, half))]
    return np.array(ends)


def true_edges(surface: str) -> np.ndarray:
    """Points along all sharp edges of a prism or of the capped cylinder."""
    if surface == "capped_cylinder":
        count = int(np.pi * EDGE_DENSITY)
        return np.vstack([circle(0.5, (0, 0, z), (1, 0, 0), (0, 1, 0), count) for z in (-0.5, 0.5)])
    ends = prism_edges(surface)
    counts = 2 + (EDGE_DENSITY * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)).astype(int)
    return np.vstack([along(edge[None], count) for edge, count in zip(ends, counts, strict=True)])


def cube_edges() -> np.ndarray:
    """Points along the twelve edges, fewer than :func:`true_edges` has."""
    return along(prism_edges("cube"), CURVE_DENSITY)


def true_rim(surface: str) -> np.ndarray:
    """Points along the rims of an open surface: cylinder, half torus or helicoid."""
    if surface in RIM_RADII:
        radius = RIM_RADII[surface]
        count = 2 + int(CURVE_DENSITY * 2.0 * np.pi * radius)
        if surface == "cylinder":
            return np.vstack([circle(radius, (0, 0, z), (1, 0, 0), (0, 1, 0), count) for z in (-1.0, 1.0)])
        return np.vstack([circle(radius, (x, 0, 0), (1, 0, 0), (0, 0, 1), count) for x in (-1.0, 1.0)])
    v = np.linspace(-np.pi, np.pi, int(CURVE_DENSITY * 2 * np.pi))[:, None]
    helices = [np.hstack([u * np.cos(v), u * np.sin(v), 0.5 * v]) for u in (-1.0, 1.0)]
    straight = [along(np.array([[(-1.0, 0, z), (1.0, 0, z)]]), 2 * CURVE_DENSITY) for z in (-0.5 * np.pi, 0.5 * np.pi)]
    return np.vstack(helices + straight)
