// An order of the points in which neighbours in space are mostly neighbours in memory.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "point_cloud.h"

namespace curvature_lines {

// Indices along the Z-order curve (Morton 1966) through the bounding box, ties by index. Loops that take
// the points in this order find in the cache what the step before has read.
std::vector<Index> spatialOrder(const Eigen::Matrix3Xd& positions);

} // namespace curvature_lines
