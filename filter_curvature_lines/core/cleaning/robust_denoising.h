// Denoising by overlapping quadrics at a radius found from the data: the mixed projection of A09
// section 4 alone, without the energy; the residual |X d - dn| of its curvature estimate gates edges.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cloud_index.h"
#include "progress.h"

namespace curvature_lines {

struct RobustDenoisingOptions {
	double noise     = 0.0; // standard deviation of the positions, a length; 0: estimated
	double radius    = 0.0; // of a patch, in local spacings; 0: by leave-one-out residuals
	double sharpness = 0.7; // normals that deviate so far from varying linearly are across an edge
};

struct RobustDenoisingResult {
	Eigen::Matrix3Xd positions, normals; // 3 x N
	// Used: the option, or pointDeviation() of the smallest patches (point_deviation.h), the median over the
	// points; a length.
	double pointDeviation = 0.0;
	double radius         = 0.0; // used, in local spacings; likewise
	double doubledShare   = 0.0; // of the points, see doubled_layers.h
};

RobustDenoisingResult denoiseRobustly(
	const CloudIndex&             index,
	const RobustDenoisingOptions& options  = {},
	const Progress&               progress = {});

} // namespace curvature_lines
