// What the scaffold is triangulated from: points of the cloud no two of which are near each other, and samples of the
// creases in place of the points beside them. Internal to scaffold, but for the creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "point_subsets.h"

namespace curvature_lines {

// A crease of the surface. The ends are corners, or where the crease fades out; lines that meet end at the
// same point.
struct FeatureLine {
	Eigen::Matrix3Xd points; // 3 x K
	bool             closed = false;
};

// Points of the cloud come first, then samples of creases.
struct ScaffoldSites {
	Eigen::Matrix3Xd   points, normals; // 3 x N; normals of crease samples are zero
	std::vector<Index> source;          // N: the point of the cloud; -1: a sample of a crease
	Eigen::VectorXd    distance;        // N, lengths: wanted between neighbours
	Eigen::VectorXd    around; // N, lengths: what it is; more where the cloud is sparse, never less
	// N: the point of the sample that is nearest, whose place this is
	std::vector<Index>                   place;
	std::vector<std::pair<Index, Index>> creaseEdges; // pieces of the creases between samples

	Index size() const { return static_cast<Index>(points.cols()); }
	// Appends copies of some.
	void appendCopies(const std::vector<Index>& which);
};

// `sample`: points of a cloud, shuffled; `order`: which they are. No two points are nearer than the mean of their
// `distance`, none is nearer to a sample of a crease than its `clearance`; lengths, one for every point of the sample.
// Creases are cut into pieces of about the clearance.
ScaffoldSites chooseSites(
	const PointSample&              sample,
	const std::vector<Index>&       order,
	const std::vector<FeatureLine>& creases,
	const Eigen::VectorXd&          distance,
	const Eigen::VectorXd&          clearance);

} // namespace curvature_lines
