// An order of the points that depends on the surface they sample and not on the order in a file.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// A fixed random permutation of the points: column k of the shuffled cloud is point order[k]. Every
// contiguous block of it is a random sample of the cloud, which is how subsets are drawn. The same points
// get the same places in whatever order they come, and (but for ties within rounding, as on an exact
// sphere) after a rigid motion.
std::vector<Index> shuffledOrder(const Eigen::Matrix3Xd& positions);

} // namespace curvature_lines
