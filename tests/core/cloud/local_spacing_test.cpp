// Spacing of grids and of clouds whose density is known, and values spread over a cloud.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "local_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "spatial_order.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

// The cloud has to be in the order it is measured with.
std::vector<double> spacingOf(const Eigen::Matrix3Xd& positions)
{
	const SpatialOrder        order(positions);
	const Eigen::Matrix3Xd    inOrder  = order.arrange(positions);
	const std::vector<double> arranged = localSpacing(inOrder, NeighborSearch(inOrder), order);
	std::vector<double>       spacing(arranged.size());
	for (std::size_t k = 0; k < arranged.size(); ++k)
		spacing[order.source[k]] = arranged[k];
	return spacing;
}

Eigen::Matrix3Xd unitSquare(int points)
{
	samples::SampleRequest request;
	request.surface = "plane";
	request.points  = points;
	request.seed    = 3;
	return samples::generate(request).positions;
}

TEST(LocalSpacing, IsTheSideOfTheSquareThatHoldsOnePoint)
{
	for (const int points : {1000, 4000, 16000}) {
		const Eigen::Matrix3Xd    positions = unitSquare(points);
		const std::vector<double> spacing   = spacingOf(positions);
		for (int i = 0; i < points; ++i) {
			const bool inside = positions.col(i).cwiseAbs().maxCoeff() < 0.3;
			if (inside) {
				EXPECT_NEAR(spacing[i] * std::sqrt(points), 1.0, 0.15);
			}
		}
	}
}

TEST(LocalSpacing, GrowsWithTheCloud)
{
	const Eigen::Matrix3Xd positions = unitSquare(2000);
	const auto             small = spacingOf(positions), large = spacingOf(50.0 * positions);
	for (std::size_t i = 0; i < small.size(); ++i)
		EXPECT_NEAR(large[i], 50.0 * small[i], 1e-6 * large[i]);
}

TEST(LocalSpacing, IsTheSameAfterARigidMotion)
{
	const Eigen::Matrix3Xd    positions = unitSquare(2000);
	const test::RigidMotion   motion;
	const std::vector<double> here  = spacingOf(positions),
							  there = spacingOf(motion.ofPoints(positions));
	for (std::size_t i = 0; i < here.size(); ++i)
		EXPECT_NEAR(there[i], here[i], 1e-9);
}

TEST(LocalSpacing, FollowsAJumpInDensity)
{
	// Four times as dense on one side: half the spacing.
	Eigen::Matrix3Xd positions(3, 8000 + 2000);
	positions << unitSquare(8000).colwise() - Eigen::Vector3d(0.5, 0, 0),
		unitSquare(2000).colwise() + Eigen::Vector3d(0.5, 0, 0);
	const auto spacing = spacingOf(positions);
	for (int i = 0; i < 10000; ++i) {
		const Eigen::Vector3d p = positions.col(i);
		if (std::abs(p.y()) > 0.25 || std::abs(std::abs(p.x()) - 0.5) > 0.25)
			continue;
		EXPECT_NEAR(spacing[i] * std::sqrt(p.x() < 0.0 ? 8000.0 : 2000.0), 1.0, 0.2);
	}
}

TEST(SpreadOver, IsTheGeometricMeanOfTheNearest)
{
	const Eigen::Matrix3Xd   positions = unitSquare(500);
	const std::vector<Index> points    = {3, 77, 200, 201, 310, 444};
	std::vector<double>      values    = {1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
	for (const Index averaged : {1, 2, 6, 100}) {
		const auto spread = spreadOver(positions, points, values, averaged);
		for (Index i = 0; i < 500; ++i) {
			std::vector<std::pair<double, double>> near;
			for (std::size_t k = 0; k < points.size(); ++k)
				near.emplace_back((positions.col(points[k]) - positions.col(i)).norm(), values[k]);
			std::sort(near.begin(), near.end());
			near.resize(std::min<std::size_t>(averaged, near.size()));
			double product = 1.0;
			for (const auto& [distance, value] : near)
				product *= value;
			EXPECT_NEAR(spread[i], std::pow(product, 1.0 / near.size()), 1e-9 * spread[i]);
		}
	}
}

} // namespace
} // namespace curvature_lines
