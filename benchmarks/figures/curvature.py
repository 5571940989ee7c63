# How right an estimate of curvature is, at the points of a cloud that are judged.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from clouds.curvature import Cloud
from clouds.generated import Truth
from harness.comparison import Figures, prefixed
from harness.results import Estimate
from harness.shared import axis_angle, rms

CLEAR_ANISOTROPY = 0.25  # of the curvature scale: where the principal directions can be judged
VANISHING = 0.05  # of the curvature scale: a mean curvature too small to be a unit of its own error


def part_of(cloud: Cloud, mask: np.ndarray, estimate: Estimate) -> tuple[Truth, np.ndarray]:
    """Truth at the estimated points of a part of the cloud, and which of the estimates these are."""
    chosen = mask[estimate.points]
    points = estimate.points[chosen]
    return {key: values[points] for key, values in cloud.truth.items()}, chosen


def curvature_scale(truth: Truth) -> float:
    return float(np.sqrt(np.mean(truth["k1"] ** 2 + truth["k2"] ** 2) / 2.0))


def mean_curvature_errors(truth: Truth, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """Relative, per point; where the surface's own mean curvature vanishes, relative to the curvature scale."""
    mean = 0.5 * (truth["k1"] + truth["k2"])
    scale = curvature_scale(truth)
    reference = np.abs(mean) if np.abs(mean).min() > VANISHING * scale else scale
    return np.abs(0.5 * (k1 + k2) - mean) / reference


def direction_error(truth: Truth, d1: np.ndarray) -> float:
    """Mean angle in radians; NaN where no point has a clear direction."""
    clear = truth["k1"] - truth["k2"] > CLEAR_ANISOTROPY * curvature_scale(truth)
    return float(axis_angle(d1[clear], truth["d1"][clear]).mean()) if clear.any() else np.nan


def larger_curvature(estimate: Estimate, chosen: np.ndarray) -> np.ndarray:
    """The larger absolute principal curvature at chosen points."""
    return np.maximum(np.abs(estimate.k1[chosen]), np.abs(estimate.k2[chosen]))


def surface_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    """Relative error of the mean curvature, mean angle of d1 in radians, per part."""
    figures: Figures = {}
    for name, mask in cloud.parts.items():
        truth, chosen = part_of(cloud, mask, estimate)
        errors = mean_curvature_errors(truth, estimate.k1[chosen], estimate.k2[chosen])
        figures |= prefixed(name, {"H": rms(errors), "direction": direction_error(truth, estimate.d1[chosen])})
    return figures


def inlier_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    errors = mean_curvature_errors(truth, estimate.k1[chosen], estimate.k2[chosen])
    return {"H": rms(errors), "H, median": float(np.median(errors))}


def k1_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    return {"k1 RMS": rms(estimate.k1[chosen] - truth["k1"])}


def edge_figures(cloud: Cloud, estimate: Estimate) -> Figures:
    """Quantiles of the larger absolute curvature (per unit length); the error of the normals in degrees."""
    truth, chosen = part_of(cloud, cloud.parts[""], estimate)
    size = larger_curvature(estimate, chosen)
    figures = {f"abs k, {percent} % quantile": float(np.percentile(size, percent)) for percent in (50, 90, 99)}
    if estimate.normals is not None:
        cosines = np.einsum("ij,ij->i", estimate.normals[chosen], truth["normals"])
        figures["normals RMS, degrees"] = rms(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))
    return figures


def absolute_errors(estimate: Estimate, truth: Truth, judged: np.ndarray) -> Figures:
    """Errors per unit length at the judged points (mask), of an estimate at all points of a cloud."""
    k1, k2 = estimate.k1[judged] - truth["k1"][judged], estimate.k2[judged] - truth["k2"][judged]
    return {
        "H": float(np.abs(0.5 * (k1 + k2)).mean()),
        "H RMS": rms(0.5 * (k1 + k2)),
        "k1 RMS": rms(k1),
        "k2 RMS": rms(k2),
        "k1, k2 RMS": rms(np.concatenate([k1, k2])),
        "direction, radians": float(axis_angle(estimate.d1, truth["d1"])[judged].mean()),
    }
