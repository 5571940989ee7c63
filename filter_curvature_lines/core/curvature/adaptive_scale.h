// The scale at which curvature is estimated, found from the cloud itself: all candidate scales run on two
// random halves of the points; the halves are independent, so their difference measures the variance of
// an estimate and their agreement measures its bias.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "members.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "scale_mixture.h"
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

struct ScaleSelection {
	std::vector<CurvatureScale> scales;    // all candidates
	Eigen::Matrix3Xd            positions; // where the mixtures hold
	std::vector<ScaleMixture>   mixtures;  // one per position
	// scale_ladder.h; lengths.
	double usualRadius     = 0.0;
	double quadricResidual = 0.0;
};

// `sample`: shuffled, with gate normals.
ScaleSelection selectScales(
	const PointSample&          sample,
	const AdaptiveScaleOptions& options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
