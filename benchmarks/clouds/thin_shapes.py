# Exact solids with thin, pointed, rounded or sparse parts, and real shapes without outliers: every point is on the surface.
# Two of several bodies and two open ones are among them.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from clouds.cleaning import SMALLEST_NOISE_UNIT, Cloud
from clouds.scans import oriented_vertices

Points = np.ndarray  # N x 3

SOLID_POINTS = 10000  # .036 spacings of a unit sphere

# Closed and without outliers, in the data folder.
REAL_SHAPES = {
    "bunny": "bunny_oriented.ply",
    "armadillo": "armadillo.obj",
    "cow": "cow.obj",
    "hand": "hand_closed.obj",
    "horse": "horse_oriented.ply",
    "fish": "fish_oriented.ply",
    "rocker arm": "rocker_arm_oriented.ply",
}


def without_outliers(positions: Points, outward: Points) -> Cloud:
    count = len(positions)
    size = np.linalg.norm(positions.max(axis=0) - positions.min(axis=0))
    return Cloud(
        positions,
        outward,
        np.zeros(count, bool),
        np.full(count, SMALLEST_NOISE_UNIT * size),
        lambda points: np.zeros(len(points)),
        {"": np.ones(count, bool)},
    )


def real_shape(file: Path) -> Callable[[int], Cloud]:
    return lambda _: without_outliers(*oriented_vertices(file))


def revolved(profile: Points, seed: int, count: int = SOLID_POINTS) -> Cloud:
    """The surface that a profile (distance from the axis, height) from the bottom to the top goes round, evenly sampled."""
    random = np.random.default_rng(seed)
    start, step = profile[:-1], np.diff(profile, axis=0)
    length = np.linalg.norm(step, axis=1)
    area = length * (profile[:-1, 0] + profile[1:, 0])
    piece = random.choice(len(area), count, p=area / area.sum())
    inner, outer = profile[piece, 0], profile[piece + 1, 0]
    # Along a piece the area grows with the square of the distance from the axis.
    reached = np.sqrt(inner**2 + random.random(count) * (outer**2 - inner**2))
    widening = outer - inner
    narrow = np.abs(widening) < 1e-9
    along = np.where(narrow, random.random(count), (reached - inner) / np.where(narrow, 1.0, widening))
    distance, height = (start[piece] + along[:, None] * step[piece]).T
    outward = np.column_stack([step[:, 1], -step[:, 0]])[piece] / length[piece, None]
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    return without_outliers(
        np.column_stack([distance[:, None] * around, height]),
        np.column_stack([outward[:, :1] * around, outward[:, 1]]),
    )


def sphere_up_to(radius: float) -> Points:
    """Profile of the unit sphere from the bottom up to where it is `radius` wide."""
    angle = np.linspace(np.pi, np.arcsin(radius), 200)
    return np.column_stack([np.sin(angle), np.cos(angle)])


def cone_profile() -> Points:
    profile = sphere_up_to(0.25)
    return np.vstack([profile, [0.0, profile[-1, 1] + 1.0]])


def cone(seed: int) -> Cloud:
    return revolved(cone_profile(), seed)


def rod_profile(radius: float) -> Points:
    profile, angle = sphere_up_to(radius), np.linspace(0.0, np.pi / 2.0, 24)
    cap = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.vstack([profile, cap + [0.0, profile[-1, 1] + 1.0]])


def rod(radius: float) -> Callable[[int], Cloud]:
    return lambda seed: revolved(rod_profile(radius), seed)


def capsule_profile(radius: float) -> Points:
    """A cylinder of length 2 with round ends."""
    angle = np.linspace(0.0, np.pi / 2.0, 40)
    cap = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.vstack([cap[::-1] * [1.0, -1.0] - [0.0, 1.0], cap + [0.0, 1.0]])


def capsule(seed: int) -> Cloud:
    return revolved(capsule_profile(0.1), seed, SOLID_POINTS // 2)


LIMB_RADIUS, LIMB_GAP = 0.2, 0.03
LIMB_STEP = np.array([2.0 * LIMB_RADIUS + LIMB_GAP, 0.0, 0.0])  # from the axis of one to the axis of the other


def two_limbs(seed: int) -> Cloud:
    """Two capsules side by side, less than a spacing apart."""
    limbs = [revolved(capsule_profile(LIMB_RADIUS), part, SOLID_POINTS // 2) for part in (seed, seed + 1)]
    return without_outliers(
        np.vstack([limbs[0].positions, limbs[1].positions + LIMB_STEP]), np.vstack([limb.outward for limb in limbs])
    )


PART_RADIUS, PART_POINTS = 0.5, 90


def part_centers() -> Points:
    """90 x 3: of spheres three apart, each at a height of its own."""
    places = 3.0 * np.indices((10, 9)).reshape(2, -1)
    return np.column_stack([*places, np.random.default_rng(1).uniform(-0.5, 0.5, places.shape[1])])


def many_parts(seed: int) -> Cloud:
    centers = np.repeat(part_centers(), PART_POINTS, axis=0)
    outward = np.random.default_rng(seed + 1).normal(size=centers.shape)
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    return without_outliers(centers + PART_RADIUS * outward, outward)


GRID_SIDE, GRID_HEIGHT, GRID_WAVE = 80, 6.0, 40.0  # in spacings


def bumpy_height(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, Points]:
    """Of the bumpy grid, and its upward normals (N x 3)."""
    turn = 2.0 * np.pi / GRID_WAVE
    along_x = -GRID_HEIGHT * turn * np.cos(turn * x) * np.cos(turn * y)
    along_y = GRID_HEIGHT * turn * np.sin(turn * x) * np.sin(turn * y)
    normals = np.column_stack([along_x, along_y, np.ones_like(x)])
    return GRID_HEIGHT * np.sin(turn * x) * np.cos(turn * y), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def bumpy_grid(_: int) -> Cloud:
    """An open surface of hills and hollows, a point on every node of a square grid."""
    x, y = np.indices((GRID_SIDE, GRID_SIDE), dtype=float).reshape(2, -1)
    height, normals = bumpy_height(x, y)
    return without_outliers(np.column_stack([x, y, height]), normals)


PIPE_RADIUS, PIPE_LENGTH, PIPE_NOISE, PIPE_POINTS = 50.0, 600.0, 1.0, 6000


def pipe(seed: int) -> Cloud:
    """Open at both ends, noisy along the normals."""
    random = np.random.default_rng(seed)
    angle, height = random.uniform(-np.pi, np.pi, PIPE_POINTS), random.uniform(0.0, PIPE_LENGTH, PIPE_POINTS)
    outward = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(PIPE_POINTS)])
    on_axis = np.column_stack([np.zeros((PIPE_POINTS, 2)), height])
    radius = PIPE_RADIUS + random.normal(0.0, PIPE_NOISE, PIPE_POINTS)
    return without_outliers(on_axis + radius[:, None] * outward, outward)


def ellipsoid_points(axes: tuple[float, float, float], seed: int) -> tuple[Points, Points]:
    random, scale = np.random.default_rng(seed), np.array(axes)
    unit = random.normal(size=(40 * SOLID_POINTS, 3))
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    stretched = np.linalg.norm(unit / scale, axis=1)  # area of the ellipsoid over that of the sphere
    unit = unit[random.random(len(unit)) < stretched / stretched.max()][:SOLID_POINTS]
    outward = unit / scale
    return unit * scale, outward / np.linalg.norm(outward, axis=1, keepdims=True)


def blade(seed: int) -> Cloud:
    return without_outliers(*ellipsoid_points((1.0, 0.5, 0.05), seed))


def sparse_cap(seed: int) -> Cloud:
    """The unit sphere with a sixteenth of the points within 20 degrees of the pole."""
    positions, outward = ellipsoid_points((1.0, 1.0, 1.0), seed)
    kept = (positions[:, 2] < np.cos(np.radians(20.0))) | (
        np.random.default_rng(seed + 1).random(len(positions)) < 1 / 16
    )
    return without_outliers(positions[kept], outward[kept])


BOX_RADIUS = 0.05  # of its edges
BOX_CORE = np.array([1.0, 0.7, 0.5]) - BOX_RADIUS  # half sides of the box that its surface is so far from
BOX_SPACING = 0.035  # root of the area per point


def rounded_box(seed: int) -> Cloud:
    """A box of 2 x 1.4 x 1 with edges rounded by .05, some one and a half spacings."""
    radius, core = BOX_RADIUS, BOX_CORE
    random = np.random.default_rng(seed)
    faces = [4.0 * core[(axis + 1) % 3] * core[(axis + 2) % 3] for axis in range(3)]
    edges = [np.pi * radius / 2.0 * 2.0 * core[axis] for axis in range(3)]
    areas = np.array([2.0 * area for area in faces] + [4.0 * area for area in edges] + [4.0 * np.pi * radius**2])
    kind, axes = random.choice(7, SOLID_POINTS, p=areas / areas.sum()), np.arange(3)
    # Along these axes the point is anywhere on its flat face or along its edge; along the others the surface bends.
    flat = ((kind[:, None] < 3) & (axes != kind[:, None])) | (axes == kind[:, None] - 3)
    outward = np.where(flat, 0.0, random.normal(size=(SOLID_POINTS, 3)))
    center = core * np.where(flat, random.uniform(-1.0, 1.0, (SOLID_POINTS, 3)), np.sign(outward))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    return without_outliers(center + radius * outward, outward)


SOLIDS = {
    "cone on a sphere": cone,
    "rod, radius 2.8 spacings": rod(0.1),
    "rod, radius 1.4 spacings": rod(0.05),
    "rod, radius .85 spacings": rod(0.03),
    "blade, rim of 1/7 spacing": blade,
    "box, fillets of 1.4 spacings": rounded_box,
    "sphere, cap with 1/16 of the points": sparse_cap,
}


def rounded_wall(step: float, degrees: float) -> Callable[[int], Cloud]:
    """90 x 90 points 3.6 apart on a tilted wall, noise 2.5 in depth, the depth rounded to steps of so many noises."""

    def make(seed: int) -> Cloud:
        random, noise = np.random.default_rng(seed), 2.5
        x, y = 3.6 * np.indices((90, 90)).reshape(2, -1) + random.uniform(-0.5, 0.5, (2, 8100))
        depth = np.tan(np.radians(degrees)) * x + random.normal(0.0, noise, len(x))
        unit = step * noise
        offset = random.random()
        depth = (np.round(depth / unit + offset) - offset) * unit
        return without_outliers(np.column_stack([x, y, depth]), np.tile([0.0, 0.0, 1.0], (len(x), 1)))

    return make
