# What a method made of a cloud with outliers and noise: which points it selected, how near it moved them to the surface.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import replace

import numpy as np

from clouds.cleaning import Cloud
from clouds.spacing import nearest_neighbor_distances
from harness.comparison import Figures, prefixed
from harness.results import Moved, Selection
from harness.shared import rms

EMPTIED_BALL = 3.0  # spacings
CLEARLY_OUTSIDE = 3.0  # noise units from the surface: nearer outliers cannot be told from noise


def selection_figures(cloud: Cloud, selection: Selection) -> Figures:
    """Outliers nearer than three noise units are in neither count."""
    far = np.abs(cloud.distance_before) > CLEARLY_OUTSIDE * cloud.noise_unit
    found, good, bad = selection.outliers, ~cloud.outlier, cloud.outlier & far
    figures = {"inliers selected, %": 100.0 * float(found[good].mean())}
    if bad.any():
        hits, wrong = np.count_nonzero(found & bad), np.count_nonzero(found & good)
        figures = {"recall": hits / bad.sum(), "precision": hits / max(1, hits + wrong), **figures}
    return figures


def true_shape_figures(cloud: Cloud, selection: Selection) -> Figures:
    """Of a cloud without outliers: what it lost, and the largest share lost in a ball of three spacings."""
    lost = np.flatnonzero(selection.outliers)
    worst = 0.0
    for point in cloud.positions[lost]:
        near = np.linalg.norm(cloud.positions - point, axis=1) < EMPTIED_BALL * cloud.spacing
        worst = max(worst, float(selection.outliers[near].mean()))
    return {"inliers selected, %": 100.0 * len(lost) / len(cloud.positions), "worst ball, %": 100.0 * worst}


def mixed_pixel_figures(cloud: Cloud, selection: Selection) -> Figures:
    """With the share selected of each part that has no outliers."""
    figures = selection_figures(cloud, selection)
    for name, mask in cloud.parts.items():
        if name:
            figures[f"{name} selected, %"] = 100.0 * float(selection.outliers[mask].mean())
    return figures


def part_selection_figures(cloud: Cloud, selection: Selection) -> Figures:
    figures: Figures = {}
    for name, mask in cloud.parts.items():
        part = cloud.only(mask, {})
        figures |= prefixed(name, selection_figures(part, replace(selection, outliers=selection.outliers[mask])))
    return figures


def ratio_figures(cloud: Cloud, moved: Moved) -> Figures:
    before, after = cloud.distance_before, cloud.distance(moved.positions)
    figures: Figures = {}
    for name, mask in cloud.parts.items():
        mask = mask & ~cloud.outlier
        figures |= prefixed(name, {"RMS ratio": rms(after[mask]) / rms(before[mask])})
    return figures


def error_figures(cloud: Cloud, moved: Moved) -> Figures:
    return {"RMS error": rms(cloud.distance(moved.positions)) / float(cloud.noise_unit.mean())}


def harm_figures(cloud: Cloud, moved: Moved) -> Figures:
    """In spacings; where the cloud has noise, beside what there was."""
    before, after = cloud.distance_before, np.abs(cloud.distance(moved.positions))
    figures = {
        "RMS error, spacings": rms(after) / cloud.spacing,
        "largest, spacings": float(after.max()) / cloud.spacing,
    }
    if rms(before) > 1e-3 * cloud.spacing:  # meshes and points of the public set differ by rounding
        figures["RMS ratio"] = rms(after) / rms(before)
    return figures


def layer_figures(cloud: Cloud, moved: Moved) -> Figures:
    """How far the layers of a surface that is there twice are from each other, after over before, and what is said of them."""
    before, after = cloud.distance_before, cloud.distance(moved.positions)
    upper, lower = cloud.parts["upper"], cloud.parts["lower"]
    apart = abs(float(np.median(after[upper]) - np.median(after[lower])))
    figures = {"distance left": apart / float(np.median(before[upper]) - np.median(before[lower]))}
    if "doubled_share" in moved.report:
        figures["told, %"] = 100.0 * moved.report["doubled_share"]
    return figures


def denoising_figures(cloud: Cloud, moved: Moved) -> Figures:
    """Ratios per part; of the whole: shrinking or growing, clumping, what became of the rim."""
    before, after = cloud.distance_before, cloud.distance(moved.positions)
    nearest = nearest_neighbor_distances(moved.positions)
    figures = ratio_figures(cloud, moved)
    figures["signed mean"] = abs(float(after.mean())) / rms(before)
    figures["CV of spacing"] = float(nearest.std() / nearest.mean())
    if cloud.rim_distance is not None:
        rim = cloud.rim_distance(cloud.positions) < cloud.spacing
        inwards = (cloud.rim_distance(moved.positions) - cloud.rim_distance(cloud.positions))[rim]
        figures["rim retreat"] = float(np.quantile(inwards, 0.95)) / cloud.spacing
    return figures
