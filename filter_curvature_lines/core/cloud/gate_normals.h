// Normals that tell the side of the surface and no more, for estimates of their own.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// 3 x N unit normals: the mean of the given ones around each point, of those that agree with the point's own
// unless nearly all oppose it. `search`: over the cloud's positions.
Eigen::Matrix3Xd
gateNormals(const PointCloud& cloud, const NeighborSearch& search, const Progress& progress = {});

} // namespace curvature_lines
