# From where the shapes of the table of whole meshes are looked at, and the parts worth a picture of their own.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.pictures import Camera

Box = tuple[tuple[float, float, float], tuple[float, float, float]]  # corners, as shares of the points' bounding box

Y_UP, Z_UP = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
ALL: Box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


@dataclass(frozen=True)
class Look:
    camera: Camera
    shown: Box = ALL

    def framed(self, points: np.ndarray) -> np.ndarray:
        """Those of the points (N x 3) that are to fill the picture."""
        low, size = points.min(axis=0), np.ptp(points, axis=0)
        share = (points - low) / np.where(size > 0.0, size, 1.0)
        return points[((share >= self.shown[0]) & (share <= self.shown[1])).all(axis=1)]


def looks(camera: Camera, *shown: Box) -> list[Look]:
    """Of the whole shape and of parts of it."""
    return [Look(camera), *(Look(camera, box) for box in shown)]


ASIDE = Camera((1.0, 0.5, 0.3), Z_UP)

LOOKS: dict[str, list[Look]] = {
    "horse": [
        *looks(Camera((1.0, 0.7, 0.2), Z_UP), ((0.0, 0.6, 0.75), (1.0, 1.0, 1.0))),
        Look(Camera((1.0, 0.4, -0.3), Z_UP), ((0.0, 0.5, 0.0), (1.0, 1.0, 0.3))),
    ],
    "fish": looks(
        Camera((1.0, 0.3, 0.3), Y_UP), ((0.0, 0.0, 0.0), (1.0, 1.0, 0.3)), ((0.0, 0.0, 0.4), (1.0, 0.5, 1.0))
    ),
    "rocker arm": looks(
        Camera((1.0, 0.3, 0.3), Y_UP), ((0.0, 0.0, 0.0), (1.0, 1.0, 0.25)), ((0.0, 0.0, 0.75), (1.0, 1.0, 1.0))
    ),
    "hand": looks(Camera((0.2, 0.2, 1.0), Y_UP), ((0.2, 0.75, 0.0), (1.0, 1.0, 1.0))),
    "cow": looks(
        Camera((0.5, 0.3, 1.0), Y_UP), ((0.75, 0.5, 0.0), (1.0, 1.0, 1.0)), ((0.0, 0.0, 0.0), (1.0, 0.45, 1.0))
    ),
    "bunny": looks(
        Camera((0.2, 0.2, 1.0), Y_UP), ((0.0, 0.65, 0.0), (1.0, 1.0, 1.0)), ((0.0, 0.0, 0.0), (0.7, 0.25, 1.0))
    ),
    "armadillo": looks(
        Camera((0.3, 0.2, 1.0), Y_UP), ((0.25, 0.72, 0.0), (0.75, 1.0, 1.0)), ((0.0, 0.0, 0.0), (1.0, 0.2, 1.0))
    ),
    "chameleon": looks(
        Camera((1.0, 0.3, 0.3), Y_UP), ((0.0, 0.35, 0.38), (1.0, 0.9, 0.64)), ((0.0, 0.0, 0.72), (1.0, 0.6, 1.0))
    ),
    "spike": looks(ASIDE, ((0.0, 0.0, 0.7), (1.0, 1.0, 1.0))),
    "pin_0_1": looks(ASIDE, ((0.0, 0.0, 0.6), (1.0, 1.0, 1.0))),
    "pin_0_05": looks(ASIDE, ((0.0, 0.0, 0.6), (1.0, 1.0, 1.0))),
    "blade": looks(Camera((0.5, -0.6, 0.6), Z_UP), ((0.75, 0.0, 0.0), (1.0, 1.0, 1.0))),
    "rounded_box": looks(ASIDE, ((0.7, 0.6, 0.6), (1.0, 1.0, 1.0))),
    "bumpy_grid": looks(Camera((0.4, -0.8, 0.7), Z_UP), ((0.5, 0.0, 0.0), (1.0, 0.3, 1.0))),
    "pipe": looks(Camera((1.0, 0.5, 0.8), Z_UP), ((0.0, 0.0, 0.8), (1.0, 1.0, 1.0))),
}


def looks_at(name: str) -> list[Look]:
    return LOOKS.get(name, [Look(ASIDE)])
