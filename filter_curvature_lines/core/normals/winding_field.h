// Outward directions of a cloud without normals: the dipoles whose winding number is one half on the points and whose
// directions are its gradient (winding number normal consistency, Lin et al. 2024).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dipole_sums.h"
#include "neighborhoods.h"
#include "progress.h"

namespace curvature_lines {

struct WindingField {
	Eigen::Matrix3Xd directions;  // 3 x N, unit; zero where the field is degenerate
	double           width = 1.0; // of the kernel, in spacings: follows the noise of the cloud
};

// positions: 3 x N, lengths of the order of 1; spacing: of the points, > 0.
WindingField windingField(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const DipoleSums&       sums,
	double                  spacing,
	const Progress&         progress);

} // namespace curvature_lines
