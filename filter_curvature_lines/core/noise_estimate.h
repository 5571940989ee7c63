// Spacing of the points on their surface and standard deviation from it, around every point of a cloud
// without outliers.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "blend_patch.h"

namespace curvature_lines {

// A patch narrower than this many noise units is all noise.
constexpr double minRadiusNoise = 5.0;
// In spacings: 20 points, a quadric with some to spare.
constexpr double smallestPatch = 2.5;

// Per point: side of the square that holds one point, averaged over some hundred neighbours, because radii of
// patches that overlap have to be alike. `cloud` is in `order`.
std::vector<double> localSpacing(
	const PointCloud& cloud, const SpatialOrder& order, const Progress& progress = {});

// Per point, a length; the same everywhere unless it plainly differs. From the residuals of the smallest
// patches that are wider than the noise, at a sample of the points; `input` needs no noise of its own.
std::vector<double> estimateNoise(BlendInput input, const Progress& progress = {});

} // namespace curvature_lines
