// Points with their search tree; random parts of them, from which local fits take their points; and thinning.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

// Points with their search tree. Stays where it is: the tree refers to the points.
struct PointSample {
	explicit PointSample(PointCloud points) : cloud(std::move(points)), search(cloud.positions) {}
	// `found`: over the same points, in their order.
	PointSample(PointCloud points, NeighborSearch found) :
			cloud(std::move(points)), search(std::move(found))
	{
	}
	PointSample(const PointSample&) = delete;

	const PointCloud     cloud;
	const NeighborSearch search;
};

// Columns [from, to): of a shuffled cloud, a random sample.
PointCloud blockOf(const PointCloud& cloud, Index from, Index to);

// A cloud cut into random subsets so that a ball of `radius` holds about 256 points of each. Fits at
// neighbouring places take different subsets: no fit uses many more, together they use every point.
class PointSubsets {
public:
	// `sample` must be shuffled (shuffledOrder) and outlive the subsets.
	PointSubsets(const PointSample& sample, double radius);

	const PointSample& operator[](Index place) const
	{
		return m_subsets.empty() ? m_whole : *m_subsets[place % m_subsets.size()];
	}

private:
	const PointSample&                              m_whole;
	std::vector<std::unique_ptr<const PointSample>> m_subsets; // empty: one subset, the whole
};

// Indices of points no two of which are nearer than `distance`, taken in order.
std::vector<Index> thin(const PointSample& sample, double distance);
// No two are nearer than the mean of their distances, which change slowly from point to point.
std::vector<Index> thin(const PointSample& sample, const Eigen::VectorXd& distance);

} // namespace curvature_lines
