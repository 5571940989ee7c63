// Colours that show both principal curvatures at once (Rusinkiewicz 2004, the scheme of A09 figs. 2, 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace curvature_lines {

// Hue: convex red, saddle green, concave blue; saturation grows with curvedness times the squared scale,
// taken from the 10th percentile of |k|. Returns 3 x N, 0..1. modelRadius caps the scale on flat shapes.
Eigen::Matrix3Xd
curvatureColors(const Eigen::VectorXd& k1, const Eigen::VectorXd& k2, double modelRadius);

} // namespace curvature_lines
