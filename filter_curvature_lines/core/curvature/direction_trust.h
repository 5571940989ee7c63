// What a principal direction is worth, and how the field around it turns: the weights of the smoothing energy
// (A09 section 4.3) and the field it takes for smooth.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

struct DirectionTrust {
	// N, in place of A09's |k1| / |k2|, which is 1 at umbilics and unbounded on cylinders. The standard
	// deviation of a direction is that of k1 - k2 over 2 |k1 - k2|; its inverse square is what the direction
	// weighs. Where that is not known, the anisotropy has to do, 0 at an umbilic to 2 where k1 = -k2.
	Eigen::VectorXd weight;
	// 3 x N tangent, radians per length: by how much the field turns against parallel transport. The lines of
	// a helicoid or an ellipsoid do turn; taking only parallel ones for smooth would straighten them.
	Eigen::Matrix3Xd turning;
};

// `theta`: N, angles of d1 in TangentFrame(n_i).
DirectionTrust
directionTrust(const PointCloud& cloud, const CurvatureField& field, const Eigen::VectorXd& theta);

// phi: theta_a - theta_b of parallel directions, after the smallest rotation between the tangent planes. A09
// measures both angles against the projection of p_a - p_b in each plane. To first order this is the same,
// but where the surface bends or twists that chord is not parallel to itself at its two ends.
double transportAngle(const TangentFrame& a, const TangentFrame& b);

} // namespace curvature_lines
