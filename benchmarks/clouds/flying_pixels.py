# Scenes of a depth camera and of a terrestrial laser scanner with pixels between two surfaces (flying, mixed pixels).
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from clouds.cleaning import Cloud

MIXED_SHARE = 0.7  # of the pixels at a silhouette
NEAREST_END, FARTHEST_END = 0.12, 0.92  # of the way from the front to the back, where mixed pixels may be
FOCAL_PIXELS = 365.0
DISPARITY_NOISE, BASELINE_FOCAL = 0.06, 0.075 * 580.0  # pixels; metres times pixels
WALL = 1.3
CAMERA_NOISE = DISPARITY_NOISE * WALL**2 / BASELINE_FOCAL  # on the wall
SCANNER_HEIGHT, SCANNER_RANGE, SCANNER_NOISE = 1.7, 40.0, 0.003
SMALLEST_JUMP = 0.3  # of the scanner, metres


def farthest_neighbor(ranges: np.ndarray, jump: float) -> np.ndarray:
    """The largest range among the four pixels around each that is at least ``jump`` farther; 0 where there is none."""
    padded = np.pad(np.where(np.isfinite(ranges), ranges, 0.0), 1)
    around = np.max([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]], axis=0)
    return np.where(around > ranges + jump, around, 0.0)


def mixed_at(
    silhouette: np.ndarray, front: np.ndarray, back: np.ndarray, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Which pixels are mixed, and the ranges with those replaced."""
    mixed = silhouette & (random.random(front.shape) < MIXED_SHARE)
    way = random.uniform(NEAREST_END, FARTHEST_END, front.shape)
    return mixed, np.where(mixed, front + way * (np.where(mixed, back, 0.0) - np.where(mixed, front, 0.0)), front)


def before_wall(
    rays: np.ndarray, spheres: list[tuple[np.ndarray, float]]
) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    """Depths along rays (z = 1) of spheres before the wall, and the distance of points from the nearest of them."""
    depths = np.full(rays.shape[:2], WALL)
    for center, radius in spheres:
        a, b = (rays**2).sum(axis=2), rays @ center
        under = b * b - a * (center @ center - radius**2)
        depths = np.where(under > 0.0, np.minimum(depths, (b - np.sqrt(np.abs(under))) / a), depths)

    def distance(points: np.ndarray) -> np.ndarray:
        to_spheres = [np.abs(np.linalg.norm(points - center, axis=1) - radius) for center, radius in spheres]
        return np.min([np.abs(points[:, 2] - WALL), *to_spheres], axis=0)

    return depths, distance


def depth_camera(resolution: float, objects: int) -> Callable[[int], Cloud]:
    """160 x 132 pixels times ``resolution`` in both directions; one sphere in the middle, or some anywhere."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        columns, rows = np.meshgrid(
            np.arange(-80 * resolution, 80 * resolution), np.arange(-66 * resolution, 66 * resolution)
        )
        focal = FOCAL_PIXELS * resolution
        rays = np.dstack([columns / focal, rows / focal, np.ones(columns.shape)])
        spheres = [(np.array([0.0, 0.0, 0.8]), 0.12)]
        if objects > 1:
            low, high = (-0.12, -0.1, 0.6), (0.12, 0.1, 0.95)
            spheres = [(random.uniform(low, high), random.uniform(0.04, 0.12)) for _ in range(objects)]
        depths, distance = before_wall(rays, spheres)
        back = farthest_neighbor(depths, 0.05)
        mixed, depths = mixed_at(back > 0.0, depths, back, random)
        depths = BASELINE_FOCAL / (BASELINE_FOCAL / depths + random.normal(0.0, DISPARITY_NOISE, depths.shape))
        directions = rays / np.linalg.norm(rays, axis=2, keepdims=True)
        count = mixed.size
        return Cloud(
            (rays * depths[:, :, None]).reshape(count, 3),
            -directions.reshape(count, 3),
            mixed.ravel(),
            np.full(count, CAMERA_NOISE),
            distance,
            {"": np.ones(count, bool)},
        )

    return make


def terrestrial_scan(degrees: float) -> Callable[[int], Cloud]:
    """Flat ground seen from 1.7 m up to 40 m away in a quarter turn, with eight posts; parts: ground, posts."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        around, up = np.meshgrid(np.radians(np.arange(-45, 45, degrees)), np.radians(np.arange(-60, 20, degrees)))
        rays = np.dstack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])
        with np.errstate(divide="ignore"):
            ranges = np.where(rays[:, :, 2] < 0.0, -SCANNER_HEIGHT / rays[:, :, 2], np.inf)
        ranges[ranges > SCANNER_RANGE] = np.inf
        ground = np.ones(ranges.shape, bool)
        posts = []
        for _ in range(8):
            far, side = random.uniform(3.0, 30.0), random.uniform(-0.72, 0.72)
            center, radius = far * np.array([np.cos(side), np.sin(side)]), random.uniform(0.05, 0.25)
            top = random.uniform(0.5, 3.0) - SCANNER_HEIGHT
            posts.append((center, radius))
            flat = rays[:, :, :2]
            a, b = (flat**2).sum(axis=2), flat @ center
            under = b * b - a * (center @ center - radius**2)
            at = (b - np.sqrt(np.abs(under))) / a
            hit = (under > 0.0) & (at * rays[:, :, 2] < top) & (at < ranges)
            ranges, ground = np.where(hit, at, ranges), ground & ~hit
        back = farthest_neighbor(ranges, SMALLEST_JUMP)
        mixed, ranges = mixed_at((back > 0.0) & ~ground, ranges, back, random)
        ranges = ranges + random.normal(0.0, SCANNER_NOISE, ranges.shape)
        seen = np.isfinite(ranges)

        def distance(points: np.ndarray) -> np.ndarray:
            to_posts = [np.abs(np.linalg.norm(points[:, :2] - center, axis=1) - radius) for center, radius in posts]
            return np.min([np.abs(points[:, 2] + SCANNER_HEIGHT), *to_posts], axis=0)

        return Cloud(
            rays[seen] * ranges[seen][:, None],
            -rays[seen],
            mixed[seen],
            np.full(np.count_nonzero(seen), SCANNER_NOISE),
            distance,
            {"ground": ground[seen], "posts": ~ground[seen] & ~mixed[seen]},
        )

    return make
