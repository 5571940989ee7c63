// Outliers of a cloud of positions, by the robust votes with their defaults.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "outlier_result.h"
#include "point_cloud.h"
#include "robust_outliers.h"

namespace curvature_lines::test {

// N, 1 = rejected.
inline std::vector<char> rejectedOf(const Eigen::Matrix3Xd& positions)
{
	Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, positions.cols());
	normals.row(2).setOnes();
	const PreparedCloud prepared = prepareCloud(positions, normals);
	const OutlierResult result   = rejectByRobustVotes(prepared.cloud, 3.5, 3);
	std::vector<char>   rejected(positions.cols(), 0);
	for (Index i = 0; i < prepared.cloud.size(); ++i)
		rejected[prepared.source[i]] = result.outlier[i];
	return rejected;
}

} // namespace curvature_lines::test
