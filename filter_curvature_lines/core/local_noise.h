// Spacing and noise of a cloud where they vary from place to place.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "neighborhoods.h"
#include "patch_blend.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

// Per point, a length: side of the square that holds one point, averaged over some hundred neighbours, so
// that radii in its unit are alike where patches overlap. `search`: over the positions; `order`: of them.
std::vector<double> localSpacing(
	const PointCloud&     cloud,
	const NeighborSearch& search,
	const SpatialOrder&   order,
	const Progress&       progress = {});

// Per point, a length: standard deviation of the positions from small patches that cover a fair sample of
// the cloud. As smooth as the spacing; at least 1e-10.
std::vector<double>
localNoise(const PatchBlend& blend, const PointCloud& cloud, const SpatialOrder& order);

} // namespace curvature_lines
