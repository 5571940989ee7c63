// Standard deviation of the points across the surface, where it varies from place to place.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "blended_surface.h"
#include "point_cloud.h"
#include "spatial_order.h"

namespace curvature_lines {

// Per point, a length, at least 1e-10: the root of a lower quantile of the residual variances of the patches around
// (SurfacePatch::scale squared), over what that quantile is of a chi-squared variable. Of the smallest patches that
// hold enough points, so it contains less detail of the surface than OutlierResult::heightDeviation.
std::vector<double>
pointDeviation(const BlendedSurface& blend, const PointCloud& cloud, const SpatialOrder& order);

} // namespace curvature_lines
