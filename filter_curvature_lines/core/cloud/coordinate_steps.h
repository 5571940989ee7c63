// Coordinates that were rounded to steps: depth cameras, files of few decimals.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace curvature_lines {

struct SpreadCoordinates {
	Eigen::Matrix3Xd positions; // 3 x N
	// Usual step per axis; 0 where the coordinates are not stepped, and then they are unchanged.
	Eigen::Vector3d steps = Eigen::Vector3d::Zero();

	bool any() const { return steps.maxCoeff() > 0.0; }
};

// On axes whose coordinates repeat exactly, a few values with gaps of .2 to 3 spacings between them, each point is moved to
// a random place in the interval that is rounded to its value, more likely near the fuller of the intervals beside it. What
// is on a surface then looks about as it did before the rounding, and robust estimates of a deviation do not collapse
// because most points are on one value. The place depends on the coordinates of the point alone.
// `spacing`: a length, side of the square that each point has.
SpreadCoordinates spreadOverSteps(const Eigen::Matrix3Xd& positions, double spacing);

} // namespace curvature_lines
