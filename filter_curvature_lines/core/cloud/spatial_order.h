// An order of the points in which near ones follow each other, so that a cache holds what they share.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// Place k in the order belongs to point source[k] of the cloud, whose place in shuffledOrder() is rank[k]:
// the points with rank[k] < m are a fair sample of m points. Neither depends on the order of the cloud.
struct SpatialOrder {
	std::vector<Index> source, rank;

	explicit SpatialOrder(const Eigen::Matrix3Xd& positions); // along a Morton curve
	// Places of the first m points of the shuffled order, ascending.
	std::vector<Index> sample(Index m) const;
	// 3 x N columns of the cloud in this order, and back.
	Eigen::Matrix3Xd arrange(const Eigen::Matrix3Xd& columns) const;
	Eigen::Matrix3Xd restore(const Eigen::Matrix3Xd& columns) const;
};

// The same points in this order.
PreparedCloud inSpatialOrder(const PreparedCloud& prepared);

} // namespace curvature_lines
