// The scale at which curvature is estimated, found from the cloud itself: all candidate scales run on two
// random halves of the points; the halves are independent, so their difference measures the variance of
// an estimate and their agreement measures its bias.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "members.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "surface_anchors.h"

namespace curvature_lines {

struct AdaptiveScaleOptions {
	Index minProbes = 512; // places where scales are compared: one in 20 points within these bounds
	Index maxProbes = 2048;
};

inline bool operator==(const AdaptiveScaleOptions& a, const AdaptiveScaleOptions& b)
{
	return members<2>(a) == members<2>(b);
}

// How much an estimate at one place relies on each scale.
struct ScaleMixture {
	// (index into ScaleSelection::scales, share), the largest first
	std::vector<std::pair<int, double>> weights;
	double                              variance = 0.0; // of the shape operator, 1/length^2
};

struct ScaleSelection {
	std::vector<CurvatureScale> scales;            // all candidates
	Eigen::Matrix3Xd            positions;         // where the mixtures hold
	std::vector<ScaleMixture>   mixtures;          // one per position
	double                      usualRadius = 0.0; // of the balls that hold just enough points
	// Root mean square of the heights of points over a quadric in the smallest ball that reaches beyond the noise,
	// a lower quantile over the cloud; a length. Without a correction for the unknowns of the fit.
	double quadricResidual = 0.0;
};

// `sample`: shuffled, with gate normals.
ScaleSelection selectScales(
	const PointSample&          sample,
	const AdaptiveScaleOptions& options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
