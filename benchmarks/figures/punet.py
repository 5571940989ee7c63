# The measures of the denoising set of PU-Net, as the evaluation of ScoreDenoise (Luo and Hu, ICCV 2021) defines them.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from clouds.punet import PublicCloud
from figures.mesh import distances

UNIT = 1e-4  # of the squared distances, in the published tables


def unit_sphere(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre of the box of some points (N x 3), and the distance of the farthest one from it."""
    center = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return center, float(np.linalg.norm(points - center, axis=1).max())


def chamfer_distance(cloud: PublicCloud, positions: np.ndarray) -> float:
    """Mean squared distance to the nearest clean point, and the same the other way round; in units of 1e-4."""
    center, radius = unit_sphere(cloud.clean)
    moved, clean = (positions - center) / radius, (cloud.clean - center) / radius
    there, back = distances(moved, clean), distances(clean, moved)
    return float(np.mean(there**2) + np.mean(back**2)) / UNIT


def wrong_sides(cloud: PublicCloud, normals: np.ndarray) -> float:
    """Share of the normals (N x 3) that look inward, %."""
    return 100.0 * float(np.mean(np.einsum("ij,ij->i", normals, cloud.outward) <= 0.0))


def unsigned_angle(cloud: PublicCloud, normals: np.ndarray) -> float:
    """Mean angle to the true normals, whatever the side; degrees."""
    lengths = np.linalg.norm(normals, axis=1) * np.linalg.norm(cloud.outward, axis=1)
    cosine = np.abs(np.einsum("ij,ij->i", normals, cloud.outward)) / np.maximum(lengths, 1e-300)
    return float(np.degrees(np.arccos(np.minimum(cosine, 1.0))).mean())
