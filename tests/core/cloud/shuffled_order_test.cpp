// The order of the points that subsets are drawn from: a permutation that belongs to the points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "shuffled_order.h"

namespace curvature_lines {
namespace {

Eigen::Matrix3Xd unitCloud(const std::string& surface, int points, double noise = 0.0)
{
	samples::SampleRequest request;
	request.surface                   = surface;
	request.points                    = points;
	request.noise                     = noise;
	request.seed                      = 3;
	const samples::SampleCloud sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud.positions;
}

TEST(ShuffledOrder, IsAPermutation)
{
	for (const int n : {1, 2, 3, 20, 1000}) {
		const Eigen::Matrix3Xd positions = unitCloud("torus", 1000).leftCols(n);
		std::vector<Index>     order     = shuffledOrder(positions);
		std::sort(order.begin(), order.end());
		std::vector<Index> all(n);
		std::iota(all.begin(), all.end(), 0);
		EXPECT_EQ(order, all);
	}
	EXPECT_TRUE(shuffledOrder(Eigen::Matrix3Xd(3, 0)).empty());
}

TEST(ShuffledOrder, BelongsToThePointsNotToTheirOrder)
{
	const Eigen::Matrix3Xd positions = unitCloud("torus", 3000, 0.005);
	const Index            n         = static_cast<Index>(positions.cols());
	std::vector<Index>     moved(n);
	std::iota(moved.begin(), moved.end(), 0);
	std::shuffle(moved.begin(), moved.end(), std::mt19937(1));
	Eigen::Matrix3Xd permuted(3, n);
	for (Index k = 0; k < n; ++k)
		permuted.col(k) = positions.col(moved[k]);
	const std::vector<Index> order = shuffledOrder(positions), other = shuffledOrder(permuted);
	for (Index k = 0; k < n; ++k)
		EXPECT_EQ(order[k], moved[other[k]]);
}

TEST(ShuffledOrder, StaysAfterRigidMotion)
{
	const Eigen::Matrix3Xd positions = unitCloud("ellipsoid", 3000, 0.005);
	const Eigen::Matrix3d  rotation =
		Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.3).normalized()).toRotationMatrix();
	EXPECT_EQ(shuffledOrder(positions), shuffledOrder(rotation * positions));
}

TEST(ShuffledOrder, PointsAtEqualDistanceAreToldApartByTheirCoordinates)
{
	Eigen::Matrix3Xd corners(3, 8); // all at the same distance from the centroid
	for (int i = 0; i < 8; ++i)
		corners.col(i) =
			Eigen::Vector3d(i & 1, (i >> 1) & 1, i >> 2) / 2.0 - Eigen::Vector3d::Constant(0.25);
	const Eigen::Matrix3Xd   reversed = corners.rowwise().reverse();
	const std::vector<Index> order = shuffledOrder(corners), other = shuffledOrder(reversed);
	for (int k = 0; k < 8; ++k)
		EXPECT_EQ(order[k], 7 - other[k]);
}

// Every block is a sample of the whole: each octant gets its share of it.
TEST(ShuffledOrder, BlocksAreFairSamples)
{
	const Eigen::Matrix3Xd   positions = unitCloud("torus", 8000);
	const std::vector<Index> order     = shuffledOrder(positions);
	const auto               octant    = [&](Index i) {
        return int(positions(0, i) > 0) + 2 * int(positions(1, i) > 0) +
               4 * int(positions(2, i) > 0);
	};
	std::array<double, 8> whole{};
	for (const Index i : order)
		whole[octant(i)] += 1.0 / order.size();
	for (int block = 0; block < 8; ++block) {
		std::array<double, 8> share{};
		for (int k = 0; k < 1000; ++k)
			share[octant(order[1000 * block + k])] += 1e-3;
		for (int o = 0; o < 8; ++o) // five standard deviations of a random choice
			EXPECT_NEAR(share[o], whole[o], 5.0 * std::sqrt(whole[o] / 1000.0));
	}
}

} // namespace
} // namespace curvature_lines
