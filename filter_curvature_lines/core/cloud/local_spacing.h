// Spacing of a cloud where it varies from place to place.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

// Positive values at some points spread over all: the geometric mean of the `averaged` nearest.
std::vector<double> spreadOver(
	const Eigen::Matrix3Xd&    positions,
	const std::vector<Index>&  points, // that have a value
	const std::vector<double>& values, // one per point of `points`
	Index                      averaged,
	const Progress&            progress = {});

// Per point, a length: side of the square that holds one point, averaged over some hundred neighbours, so
// that radii in its unit are alike where patches overlap. `positions` are in `order`, `search` is over them.
std::vector<double> localSpacing(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const SpatialOrder&     order,
	const Progress&         progress = {});

} // namespace curvature_lines
