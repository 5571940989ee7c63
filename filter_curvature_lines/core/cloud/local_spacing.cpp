// Estimates at a sample of the points, spread over all.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_spacing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

constexpr const char* stage = "Measuring the cloud";

} // namespace

std::vector<double> spreadOver(
	const Eigen::Matrix3Xd&    positions,
	const std::vector<Index>&  points,
	const std::vector<double>& values, // one per point of `points`
	Index                      averaged,
	const Progress&            progress)
{
	const Eigen::Matrix3Xd places = columnsOf(positions, points);
	const NeighborSearch   search(places);
	std::vector<double>    logs, smooth(positions.cols());
	for (const double value : values)
		logs.push_back(std::log(value));
	parallelFor(positions.cols(), progress, [&](Index i) {
		double                   sum  = 0.0;
		const std::vector<Index> near = search.nearest(positions.col(i), averaged);
		for (const Index k : near)
			sum += logs[k];
		smooth[i] = std::exp(sum / double(near.size()));
	});
	return smooth;
}

std::vector<double> localSpacing(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const SpatialOrder&     order,
	const Progress&         progress)
{
	constexpr Index          k = 16, averaged = 32, thinning = 8;
	const Index              n      = static_cast<Index>(positions.cols());
	const std::vector<Index> sample = order.sample(std::max(std::min(n, averaged), n / thinning));
	std::vector<double>      side(sample.size());
	parallelFor(static_cast<Index>(sample.size()), progress.sub(0.0, 0.5, stage), [&](Index s) {
		const Eigen::Vector3d    position = positions.col(sample[s]);
		const std::vector<Index> near     = search.nearest(position, k + 1);
		const double             distance = (positions.col(near.back()) - position).norm();
		side[s]                           = distance * std::sqrt(EIGEN_PI / (near.size() - 1.0));
	});
	return spreadOver(positions, sample, side, averaged, progress.sub(0.5, 1.0, stage));
}

} // namespace curvature_lines
