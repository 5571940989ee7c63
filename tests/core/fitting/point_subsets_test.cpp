// Subsets against the points they come from, thinning against the plain double loop.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_subsets.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "quantile.h"
#include "shuffled_order.h"

namespace curvature_lines::test {
namespace {

PointCloud shuffledTorus(int points)
{
	samples::SampleRequest request;
	request.points                 = points;
	const auto               cloud = samples::generate(request);
	const std::vector<Index> order = shuffledOrder(cloud.positions);
	return {cloud.positions(Eigen::all, order), cloud.normals(Eigen::all, order)};
}

using Key = std::tuple<double, double, double>;
Key keyOf(const Eigen::Matrix3Xd& m, Index k)
{
	return {m(0, k), m(1, k), m(2, k)};
}

TEST(PointSubsets, ShareAllPointsAmongThem)
{
	const PointSample            sample(shuffledTorus(6000));
	const PointSubsets           subsets(sample, 0.9);
	std::set<const PointSample*> different;
	for (Index place = 0; place < 64; ++place)
		different.insert(&subsets[place]);
	ASSERT_GT(different.size(), 1u);
	EXPECT_EQ(&subsets[0], &subsets[static_cast<Index>(different.size())]); // they take turns
	std::set<Key> found, expected;
	Index         total = 0;
	for (const PointSample* subset : different) {
		total += subset->cloud.size();
		for (Index k = 0; k < subset->cloud.size(); ++k)
			found.insert(keyOf(subset->cloud.positions, k));
		EXPECT_EQ(subset->cloud.normals.cols(), subset->cloud.size());
	}
	for (Index k = 0; k < 6000; ++k)
		expected.insert(keyOf(sample.cloud.positions, k));
	EXPECT_EQ(total, 6000);
	EXPECT_EQ(found, expected);
}

TEST(PointSubsets, BallsHoldAbout256PointsOfEach)
{
	const PointSample   sample(shuffledTorus(12000));
	const double        radius = 0.5;
	const PointSubsets  subsets(sample, radius);
	std::vector<double> counts;
	for (Index i = 0; i < 200; ++i) {
		const std::vector<Index> ball =
			subsets[i].search.within(sample.cloud.positions.col(i), radius);
		counts.push_back(double(ball.size()));
	}
	const double median = medianInPlace(counts);
	EXPECT_GT(median, 200.0);
	EXPECT_LT(median, 520.0); // one subset fewer than fits would leave up to twice as many
}

TEST(PointSubsets, OneIsTheWholeCloudWhereBallsAreSmall)
{
	const PointSample  sample(shuffledTorus(2000));
	const PointSubsets subsets(sample, 0.1);
	for (const Index place : {0, 1, 17})
		EXPECT_EQ(&subsets[place], &sample);
}

TEST(PointSubsets, ThinningKeepsAPointUnlessOneBeforeItIsNear)
{
	const PointSample        sample(shuffledTorus(1500));
	const Eigen::Matrix3Xd&  p        = sample.cloud.positions;
	const double             distance = 0.2;
	const std::vector<Index> kept     = thin(sample, distance);
	std::vector<Index>       expected;
	for (Index i = 0; i < 1500; ++i)
		if (std::none_of(expected.begin(), expected.end(), [&](Index k) {
				return (p.col(k) - p.col(i)).norm() < distance;
			}))
			expected.push_back(i);
	EXPECT_EQ(kept, expected);
	EXPECT_LT(kept.size(), 1000u);
	EXPECT_EQ(thin(sample, 1e-9).size(), 1500u);
}

// A distance that doubles from one side of the cloud to the other.
TEST(PointSubsets, ThinningFollowsGradedDistances)
{
	const PointSample       sample(shuffledTorus(1500));
	const Eigen::Matrix3Xd& p = sample.cloud.positions;
	const Eigen::VectorXd   x = p.row(0), distance = 0.1 + 0.1 * (x.array() - x.minCoeff()) /
	                                                         (x.maxCoeff() - x.minCoeff());
	const std::vector<Index> kept = thin(sample, distance);
	std::vector<Index>       expected;
	for (Index i = 0; i < 1500; ++i)
		if (std::none_of(expected.begin(), expected.end(), [&](Index k) {
				return (p.col(k) - p.col(i)).norm() < 0.5 * (distance[k] + distance[i]);
			}))
			expected.push_back(i);
	EXPECT_EQ(kept, expected);
	const Eigen::VectorXd same = Eigen::VectorXd::Constant(1500, 0.2);
	EXPECT_EQ(thin(sample, same), thin(sample, 0.2));
}

TEST(PointSubsets, BlocksAreColumns)
{
	const PointCloud cloud = shuffledTorus(50);
	const PointCloud block = blockOf(cloud, 10, 25);
	ASSERT_EQ(block.size(), 15);
	EXPECT_EQ(block.positions, cloud.positions.middleCols(10, 15));
	EXPECT_EQ(block.normals, cloud.normals.middleCols(10, 15));
}

} // namespace
} // namespace curvature_lines::test
