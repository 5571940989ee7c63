// The order in which near points follow each other, and the samples drawn from it.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "shuffled_order.h"
#include "spatial_order.h"

namespace curvature_lines {
namespace {

Eigen::Matrix3Xd torus(int points)
{
	samples::SampleRequest request;
	request.points                    = points;
	request.seed                      = 3;
	const samples::SampleCloud sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud.positions;
}

TEST(SpatialOrder, HoldsEveryPointOnceWithItsShuffledPlace)
{
	for (const int n : {0, 1, 2, 1000}) {
		const Eigen::Matrix3Xd   positions = torus(1000).leftCols(n);
		const SpatialOrder       order(positions);
		const std::vector<Index> shuffled = shuffledOrder(positions);
		ASSERT_EQ(order.source.size(), shuffled.size());
		ASSERT_EQ(order.rank.size(), shuffled.size());
		for (std::size_t k = 0; k < order.source.size(); ++k)
			EXPECT_EQ(shuffled[order.rank[k]], order.source[k]);
		EXPECT_EQ(order.restore(order.arrange(positions)), positions);
	}
}

TEST(SpatialOrder, BelongsToThePointsNotToTheirOrder)
{
	Eigen::Matrix3Xd positions = torus(2000);
	// Many in one cell of the curve.
	positions.leftCols(200) *= 1e-6;
	std::vector<Index> moved(positions.cols());
	std::iota(moved.begin(), moved.end(), 0);
	std::shuffle(moved.begin(), moved.end(), std::mt19937(1));
	const Eigen::Matrix3Xd permuted = columnsOf(positions, moved);
	EXPECT_EQ(SpatialOrder(positions).arrange(positions), SpatialOrder(permuted).arrange(permuted));
}

TEST(SpatialOrder, NearPointsFollowEachOther)
{
	const Eigen::Matrix3Xd positions = torus(4000);
	const Eigen::Matrix3Xd arranged  = SpatialOrder(positions).arrange(positions);
	const auto             step      = [](const Eigen::Matrix3Xd& p) {
        return (p.rightCols(p.cols() - 1) - p.leftCols(p.cols() - 1)).colwise().norm().mean();
	};
	EXPECT_LT(step(arranged), 0.1 * step(positions));
}

TEST(SpatialOrder, SamplesAreTheFirstOfTheShuffledOrder)
{
	const Eigen::Matrix3Xd   positions = torus(500);
	const SpatialOrder       order(positions);
	const std::vector<Index> sample = order.sample(60);
	EXPECT_EQ(sample.size(), 60u);
	EXPECT_TRUE(std::is_sorted(sample.begin(), sample.end()));
	for (const Index k : sample)
		EXPECT_LT(order.rank[k], 60);
	EXPECT_EQ(order.sample(1000).size(), 500u);
}

TEST(SpatialOrder, PreparedCloudsKeepTheirPoints)
{
	Eigen::Matrix3Xd positions = torus(500), normals = positions.colwise().normalized();
	positions.col(7).setConstant(std::nan(""));
	positions.col(9)             = positions.col(8);
	const PreparedCloud given    = prepareCloud(positions, normals);
	const PreparedCloud arranged = inSpatialOrder(given);
	ASSERT_EQ(arranged.cloud.size(), given.cloud.size());
	EXPECT_EQ(arranged.representative[7], -1);
	EXPECT_EQ(arranged.representative[9], arranged.representative[8]);
	for (Index i = 0; i < 500; ++i) {
		const Index before = given.representative[i], now = arranged.representative[i];
		if (now < 0)
			continue;
		EXPECT_EQ(arranged.cloud.positions.col(now), given.cloud.positions.col(before));
		EXPECT_EQ(arranged.cloud.normals.col(now), given.cloud.normals.col(before));
		EXPECT_EQ(arranged.source[now], given.source[before]);
	}
}

} // namespace
} // namespace curvature_lines
