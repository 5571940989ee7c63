// Clouds with their exact curvature field, so that a stage is tested by itself: statistical weight 1 for
// every point of the operating region whose normal agrees.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analytic_surfaces.h"
#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines::test {

struct ExactCloud {
	samples::SampleCloud sample; // ground truth of every point
	PointCloud           cloud;  // exact normals, positions with the requested noise
	MinimumNeighborhoods minimum;
	CurvatureField       field;
};

inline CurvatureField exactField(
	const samples::GroundTruth& truth,
	const PointCloud&           cloud,
	const NeighborSearch&       search,
	const MinimumNeighborhoods& minimum,
	double                      regionScale = 3.0)
{
	const Index    n = cloud.size();
	CurvatureField field;
	field.k1 = truth.k1;
	field.k2 = truth.k2;
	field.d1 = truth.d1;
	field.d2 = truth.d2;
	field.error.setZero(n);
	field.radius.resize(n);
	field.confidence.setZero(n);
	field.status.assign(n, PointStatus::Ok);
	field.correctedNormals = cloud.normals;
	std::vector<std::vector<Index>> rows(n);
	for (Index i = 0; i < n; ++i) {
		field.radius[i] = regionScale * minimum.spacing[i];
		for (const Index j : search.within(cloud.positions.col(i), field.radius[i]))
			if (j != i && cloud.normals.col(i).dot(cloud.normals.col(j)) > 0.5)
				rows[i].push_back(j);
		std::sort(rows[i].begin(), rows[i].end());
		for (const Index j : rows[i])
			field.confidence[j] += 1.0;
	}
	field.weights.neighbors = NeighborLists::fromRows(rows);
	field.weights.values.assign(field.weights.neighbors.indices.size(), 1.0);
	return field;
}

inline ExactCloud exactCloud(samples::SampleCloud sample)
{
	ExactCloud result;
	result.sample = std::move(sample);
	result.cloud  = {result.sample.positions, result.sample.normals};
	const NeighborSearch search(result.cloud.positions);
	result.minimum = minimumNeighborhoods(result.cloud, search);
	result.field   = exactField(result.sample, result.cloud, search, result.minimum);
	return result;
}

inline ExactCloud exactCloud(const samples::SampleRequest& request)
{
	return exactCloud(samples::generate(request));
}

// Angle between two lines, 0 .. pi/2.
inline double lineAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
	return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

} // namespace curvature_lines::test
