// Whether normals that come with a cloud can be those of its surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// Shares of a sample of at most 2000 points, 0..1; all 0 for clouds of fewer than 20 points.
struct NormalCheck {
	bool allEqual  = false; // one normal everywhere, although the planes through the points are not
	double notUnit = 0.0;   // length off by more than a tenth
	double disagreeing =
		0.0; // more than 60 degrees from the plane through the neighbours, where there is a clear one
	double torn =
		0.0; // pairs of neighbours on one smooth surface whose normals look to opposite sides
};

// positions, normals: 3 x N; points that are not finite or have no normal take no part. Does not depend on their order.
NormalCheck checkNormals(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& normals);

} // namespace curvature_lines
