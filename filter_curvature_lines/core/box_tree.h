// Balls and nearest points by a hierarchy of bounding boxes (Roussopoulos and Leifker 1985: a packed R-tree).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// Points sorted along a space-filling curve, in boxes of eight, these in boxes of eight, and so on. Whole
// boxes are tested at once with vector instructions, which makes balls of hundreds of points, what this
// program mostly asks for, several times cheaper than a binary tree does.
class BoxTree {
public:
	using Found = std::pair<double, Index>; // squared distance, index

	explicit BoxTree(const Eigen::Matrix3Xd& positions);

	Index                     size() const { return static_cast<Index>(m_original.size()); }
	const std::vector<Index>& spatialOrder() const { return m_original; }

	// Indices of all points within `radius`, in spatial order.
	void within(const Eigen::Vector3d& query, double radius, std::vector<Index>& found) const;
	bool anyWithin(const Eigen::Vector3d& query, double radius) const;
	// The k nearest, or all if they are fewer, by (squared distance, index).
	void nearest(const Eigen::Vector3d& query, Index k, std::vector<Found>& found) const;

private:
	// Coordinates of boxes, padded to whole parents with boxes that no query meets.
	struct Level {
		std::array<std::vector<double>, 3> low, high;
	};
	// Eight children: boxes of `level`, or points where that is -1.
	struct Node {
		int   level;
		Index number;
	};
	Node  root() const { return {static_cast<int>(m_levels.size()) - 1, 0}; }
	void  distances(Node node, const double* query, double* squared) const;
	Index collect(const double* query, double squaredRadius, bool first, Index* found) const;
	// Adds what `node` holds to the nearest so far, of which no more than 2 k are kept, by the bound on the
	// squared distance that the k nearest of them set.
	void addNearest(
		const double* query, Node node, std::size_t k, double& bound, std::vector<Found>& found) const;

	std::vector<Index>                 m_original; // index per sorted point
	std::array<std::vector<double>, 3> m_points;   // sorted, padded
	std::vector<Level>                 m_levels;   // from the boxes of points to the children of the root
};

} // namespace curvature_lines
