// Noise of a cloud where it varies from place to place.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "patch_blend.h"
#include "point_cloud.h"
#include "spatial_order.h"

namespace curvature_lines {

// Per point, a length: standard deviation of the positions from small patches that cover a fair sample of
// the cloud. As smooth as the spacing; at least 1e-10.
std::vector<double>
localNoise(const PatchBlend& blend, const PointCloud& cloud, const SpatialOrder& order);

} // namespace curvature_lines
