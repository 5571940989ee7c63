// Subsets by blocks of the random order; greedy thinning.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_subsets.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

constexpr Index countedBalls =
	40; // of random points; their median says how many points a ball holds
// Points of one fit. 128 instead double the error at 2 % noise, all points instead of 256 lower it by 3 to 15 %
// (prototype measurements; docs/method.md, "Local polynomials").
constexpr double samplesPerBall = 256.0;
// Each subset has a tree of its own. Balls of 64 x 256 points hold 8 % of a cloud of 200 000 points.
constexpr Index maxSubsets = 64;

// Distances differ from point to point, but not fast: a point twice as far from its neighbours is hardly ever among them.
constexpr double gradedReach = 1.5;

// In order: a point that is kept covers those within its reach for which `covers` says so.
template<class Reach, class Covers>
std::vector<Index> thinned(const PointSample& sample, const Reach& reach, const Covers& covers)
{
	const Index        n = sample.cloud.size();
	std::vector<char>  covered(n, 0);
	std::vector<Index> kept, found;
	for (Index i = 0; i < n; ++i) {
		if (covered[i])
			continue;
		kept.push_back(i);
		sample.search.within(sample.cloud.positions.col(i), reach(i), found);
		for (const Index j : found)
			if (covers(i, j))
				covered[j] = 1;
	}
	return kept;
}

} // namespace

PointCloud blockOf(const PointCloud& cloud, Index from, Index to)
{
	return {cloud.positions.middleCols(from, to - from), cloud.normals.middleCols(from, to - from)};
}

PointSubsets::PointSubsets(const PointSample& sample, double radius) : m_whole(sample)
{
	const Index         n = sample.cloud.size();
	std::vector<double> counts;
	std::vector<Index>  found;
	for (Index i = 0; i < std::min(n, countedBalls); ++i) {
		sample.search.within(sample.cloud.positions.col(i), radius, found);
		counts.push_back(double(found.size()));
	}
	const auto subsets = std::clamp(
		static_cast<Index>(medianInPlace(counts) / samplesPerBall), Index(1), maxSubsets);
	if (subsets == 1)
		return;
	// Each keeps the spatial order.
	std::vector<std::vector<Index>> members(subsets);
	for (const Index i : sample.search.spatialOrder())
		members[(std::int64_t(i + 1) * subsets - 1) / n].push_back(i);
	for (const std::vector<Index>& subset : members)
		m_subsets.push_back(
			std::make_unique<const PointSample>(PointCloud{
				sample.cloud.positions(Eigen::all, subset),
				sample.cloud.normals(Eigen::all, subset)}));
}

std::vector<Index> thin(const PointSample& sample, double distance)
{
	return thinned(sample, [&](Index) { return distance; }, [](Index, Index) { return true; });
}

std::vector<Index> thin(const PointSample& sample, const Eigen::VectorXd& distance)
{
	const Eigen::Matrix3Xd& at = sample.cloud.positions;
	return thinned(
		sample,
		[&](Index i) { return gradedReach * distance[i]; },
		[&](Index i, Index j) {
			return (at.col(j) - at.col(i)).norm() < 0.5 * (distance[i] + distance[j]);
		});
}

} // namespace curvature_lines
