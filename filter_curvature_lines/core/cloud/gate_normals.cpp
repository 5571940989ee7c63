// Means of normals over the nearest neighbours.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "gate_normals.h"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// By experiment: with 60 neighbours 30 % of random normals change no estimate (benchmarks/curvature.py, "Random normals").
constexpr Index gateNeighbors = 60;
// Share of the neighbours that agree with a point's own normal; with fewer it is the point's that is wrong.
constexpr double minAgreement = 0.25;

} // namespace

Eigen::Matrix3Xd
gateNormals(const PointCloud& cloud, const NeighborSearch& search, const Progress& progress)
{
	Eigen::Matrix3Xd gate(3, cloud.size());
	parallelForPoints(search, progress, [&](Index i) {
		const std::vector<Index> near = search.nearest(cloud.positions.col(i), gateNeighbors);
		const Eigen::Vector3d    own  = cloud.normals.col(i);
		Eigen::Vector3d          same = Eigen::Vector3d::Zero(), all = Eigen::Vector3d::Zero();
		std::size_t              agree = 0;
		for (const Index j : near) {
			all += cloud.normals.col(j);
			if (own.dot(cloud.normals.col(j)) > 0.5) { // random normals hardly agree so far
				same += cloud.normals.col(j);
				++agree;
			}
		}
		const Eigen::Vector3d sum = agree < minAgreement * near.size() ? all : same;
		gate.col(i)               = sum.norm() > 1e-9 ? Eigen::Vector3d(sum.normalized()) : own;
	});
	return gate;
}

} // namespace curvature_lines
