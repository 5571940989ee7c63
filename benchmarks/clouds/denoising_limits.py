# Clouds on which denoising can only do harm, or hardly anything but harm: exact ones with detail as narrow as the points are
# apart, walls as thin as that, clean shapes of a public denoising set, and surfaces that are there twice.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pymeshlab

from clouds.cleaning import Cloud, sampled, signed_distance
from clouds.thin_shapes import without_outliers

POINTS = 8000
LAYER_NOISE = 0.03  # spacings, of layers that are there twice
Distance = Callable[[np.ndarray], np.ndarray]


def exact_cloud(positions: np.ndarray, outward: np.ndarray, noise: np.ndarray, distance: Distance) -> Cloud:
    """With noise along the normals (a length per point) and the true normals."""
    moved = positions + noise[:, None] * outward
    return replace(without_outliers(moved, outward), distance=distance, exact_normals=True)


def fillet(radius: float) -> Callable[[int], Cloud]:
    """Two unit squares at a right angle, joined by a fillet whose radius is so many spacings."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        size = radius / np.sqrt(POINTS / 2.0)
        arc = 0.5 * np.pi * size
        along, y = random.uniform(-1.0, 1.0 + arc, POINTS), random.random(POINTS)
        turn = np.clip(along, 0.0, arc) / size
        before, after = np.minimum(along, 0.0), np.maximum(along - arc, 0.0)
        outward = np.column_stack([np.sin(turn), np.zeros(POINTS), np.cos(turn)])
        positions = np.column_stack([before + size * outward[:, 0], y, size * outward[:, 2] - after])

        def distance(points: np.ndarray) -> np.ndarray:
            across = points[:, [0, 2]]
            return np.linalg.norm(np.maximum(across, 0.0), axis=1) + np.minimum(across.max(axis=1), 0.0) - size

        return exact_cloud(positions, outward, np.zeros(POINTS), distance)

    return make


def thin_disk(thickness: float, noise: float) -> Callable[[int], Cloud]:
    """A disk of radius 1 with a round rim, so many spacings thick, with so many spacings of noise."""

    def make(seed: int) -> Cloud:
        random = np.random.default_rng(seed)
        spacing = np.sqrt(2.0 * np.pi / POINTS)
        half = 0.5 * thickness * spacing
        flat = 1.0 - half  # radius of the two flat sides
        areas = np.array([flat**2, flat**2, 2.0 * np.pi * half * (flat + 2.0 * half / np.pi)])
        part, angle = random.choice(3, POINTS, p=areas / areas.sum()), random.uniform(0.0, 2.0 * np.pi, POINTS)
        slope = np.where(
            part == 2, np.arcsin(random.uniform(-1.0, 1.0, POINTS)), np.where(part == 0, 0.5, -0.5) * np.pi
        )
        center = np.where(part == 2, flat, flat * np.sqrt(random.random(POINTS)))
        around = np.column_stack([np.cos(angle), np.sin(angle)])
        outward = np.column_stack([np.cos(slope)[:, None] * around, np.sin(slope)])
        positions = half * outward + np.column_stack([center[:, None] * around, np.zeros(POINTS)])

        def distance(points: np.ndarray) -> np.ndarray:
            outside = np.maximum(np.hypot(points[:, 0], points[:, 1]) - flat, 0.0)
            return np.hypot(outside, points[:, 2]) - half

        return exact_cloud(positions, outward, noise * spacing * random.normal(size=POINTS), distance)

    return make


def registered_badly(surface: str, distance: float, share: float = 1.0) -> Callable[[int], Cloud]:
    """Two samples of a surface, the second so many spacings outside the first; of it only this share of the points."""

    def make(seed: int) -> Cloud:
        first, second = sampled(surface, POINTS, 0.0)(seed), sampled(surface, POINTS, 0.0)(seed + 100)
        kept = np.random.default_rng(seed).random(POINTS) < share
        shifted = (second.positions + distance * first.spacing * second.outward)[kept]
        upper = np.arange(POINTS + len(shifted)) >= POINTS
        outward = np.vstack([first.outward, second.outward[kept]])
        noise = LAYER_NOISE * first.spacing * np.random.default_rng(seed + 1).normal(size=len(upper))
        cloud = exact_cloud(np.vstack([first.positions, shifted]), outward, noise, signed_distance(surface))
        return replace(cloud, parts={"lower": ~upper, "upper": upper})

    return make


def with_true_mesh(file: Path, name: str, clean: str) -> Cloud:
    """A cloud of a file of the set, with the normals of the mesh at its clean points."""
    arrays = np.load(file)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(arrays["mesh_vertices"], arrays["mesh_triangles"]))
    meshes.compute_normal_per_vertex()

    def added(points: np.ndarray) -> int:
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
        return meshes.current_mesh_id()

    def distance(points: np.ndarray) -> np.ndarray:
        meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
            measuremesh=added(points), refmesh=0, signeddist=False
        )
        return meshes.current_mesh().vertex_scalar_array()

    meshes.transfer_attributes_per_vertex(
        sourcemesh=0, targetmesh=added(arrays[clean].astype(float)), normaltransfer=True, colortransfer=False
    )
    outward = meshes.current_mesh().vertex_normal_matrix()
    outward = outward / np.linalg.norm(outward, axis=1, keepdims=True)
    positions = arrays[name].astype(float)
    return exact_cloud(positions, outward, np.zeros(len(positions)), distance)
