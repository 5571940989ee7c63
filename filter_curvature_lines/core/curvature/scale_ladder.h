// The ladder of radii at which curvature is tried, from the smallest ball that determines a fit to a large share of the
// cloud, and how large residuals are in balls that lie within the noise. Internal to adaptive_scale.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "point_subsets.h"

namespace curvature_lines {

// Each radius is so many times the one before. By experiment: with 1.45 or 1.5 the selection is a third faster and misses
// the best scale on some clouds (docs/method.md, "Scale").
constexpr double ladderStep = 1.3;

// Residuals in radii, by the same experiments. A scale with a larger median over the probes is not valid; .12 in place of
// .2 loses the right scales at 2 % noise, .4 changes nothing. A ball no thicker than the noisy layer has at least the
// second one.
constexpr double largestResidual = 0.2;
constexpr double clippedResidual = 0.15;
// This quantile of the residuals over the cloud is free of edges: no edge is near a third of all places.
constexpr double smoothShare = 1.0 / 3.0;
// Of a height fit at a probe, each in the frame of the one before.
constexpr int probeIterations = 3;

// Radii of balls for heights; lengths, in the unit frame (the diagonal of the cloud's bounding box is 1).
struct ScaleLadder {
	double usualRadius    = 0.0; // of the balls that hold just enough points for a quartic
	double smallestRadius = 0.0; // less than that in clouds with parts much denser than the rest
	int    levels         = 1;   // at least one

	double radius(int level) const { return smallestRadius * std::pow(ladderStep, level); }
	// Half way from the usual radius to the largest.
	double middleRadius() const;
};

// `sample`: shuffled, at least one point.
ScaleLadder scaleLadder(const PointSample& sample);

// Root mean square of the heights of points over a quadric in the smallest ball of the ladder that reaches beyond the
// noisy layer, a lower quantile over the cloud; a length. Without a correction for the unknowns of the fit. `sample`:
// shuffled, with gate normals.
double quadricResidual(const PointSample& sample, const ScaleLadder& ladder);

} // namespace curvature_lines
