// Overlapping local quadrics and, at every point, the blend of all that cover it: the mixed projection
// of A09 section 4 with quadrics of hundreds of points, weighted by inverse prediction variance.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "covering_patch.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Per point of the input, and at points that were not asked for the guide itself.
struct BlendedSurface {
	Eigen::Matrix3Xd    positions, normals; // 3 x N
	std::vector<double> residual; // leave-one-out, a length; infinite where no patch reaches
	std::vector<double> height;   // the same with the point itself: of the input over the surface
	std::vector<double> purity;   // 0..1: share of the patches' weight that their residuals leave
	// Per valid patch: the point at its centre; of its residuals, see SurfacePatch.
	std::vector<Index>  center;
	std::vector<double> variance, effectiveCount;
};

// At the points of `targets` only, with the patches they need; best in ascending order.
BlendedSurface blendPatches(
	const BlendInput&         input,
	const BlendGuide&         guide,
	const BlendOptions&       options,
	const std::vector<Index>& targets,
	const Progress&           progress = {});

} // namespace curvature_lines
