// Points on lines that are much farther apart than the points of a line: line scanners, rows of a depth image.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

// Per point; empty where the cloud has no lines.
struct ScanLines {
	std::vector<double> gap;       // from a line to the next, a length; 0 where points lie on none
	Eigen::Matrix3Xd    direction; // 3 x N, unit; of no meaning where there is no line

	bool any() const { return !gap.empty(); }
};

// Lines whose gap is at least some four times the distance of their points: the nearest nine points all lie on one. Of a
// random sample they never do for long, so that clouds without lines get none. `positions` are in `order`, `search` is
// over them.
ScanLines scanLines(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const SpatialOrder&     order,
	const Progress&         progress = {});

} // namespace curvature_lines
