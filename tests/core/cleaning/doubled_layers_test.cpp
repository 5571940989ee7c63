// A torus that a bad registration left twice is told, and what is not twice is not.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "doubled_layers.h"
#include "point_cloud.h"
#include "robust_denoising.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr int points = 4000;

struct Twice {
	const samples::AnalyticSurface& surface = samples::surface("torus");
	PointCloud                      cloud;    // in the unit frame
	std::vector<char>               upper;    // per point, whether it is in the second layer
	double spacing = std::sqrt(1.9 / points); // the area is below 1.9 diagonals^2

	// A second sample `distance` spacings outside, where its points have x > `from`.
	Twice(double distance, double noise, double from = -10.0)
	{
		std::vector<Vector3d> positions, normals;
		samples::Random       random(5, 1);
		for (const bool second : {false, true}) {
			samples::SampleRequest request;
			request.points  = points;
			request.seed    = second ? 8 : 7;
			const auto made = samples::generate(request);
			for (int i = 0; i < points; ++i) {
				const Vector3d n = made.normals.col(i),
							   p = made.positions.col(i) / surface.diagonal();
				if (second && (distance == 0.0 || p.x() < from))
					continue;
				const double height = (second ? distance : 0.0) + noise * random.normal3().x();
				positions.emplace_back(p + height * spacing * n);
				normals.push_back(n);
				upper.push_back(second);
			}
		}
		cloud.positions.resize(3, positions.size());
		cloud.normals.resize(3, positions.size());
		for (std::size_t i = 0; i < positions.size(); ++i) {
			cloud.positions.col(i) = positions[i];
			cloud.normals.col(i)   = normals[i];
		}
	}
	// Mean height of the second layer over the first, in spacings.
	double separation(const Eigen::Matrix3Xd& positions) const
	{
		double sum[2] = {}, count[2] = {};
		for (Index i = 0; i < positions.cols(); ++i) {
			const Vector3d p = positions.col(i) * surface.diagonal(), foot = surface.project(p);
			sum[upper[i] ? 1 : 0] += (p - foot).dot(surface.frame(foot).normal);
			count[upper[i] ? 1 : 0] += 1.0;
		}
		return (sum[1] / count[1] - sum[0] / count[0]) / surface.diagonal() / spacing;
	}
};

TEST(DoubledLayers, BecomeOneSheetAndAreTold)
{
	for (const double distance : {0.2, 0.5, 1.0}) {
		SCOPED_TRACE(distance);
		const Twice twice(distance, 0.03);
		const auto  result = denoiseRobustly(twice.cloud);
		EXPECT_LT(std::abs(twice.separation(result.positions)), 0.05 * distance);
		EXPECT_GT(result.doubledShare, 0.8);
	}
}

TEST(DoubledLayers, FartherApartTheyAreTold)
{
	for (const double distance : {1.5, 2.0})
		EXPECT_GT(denoiseRobustly(Twice(distance, 0.03).cloud).doubledShare, 0.8) << distance;
}

TEST(DoubledLayers, TellsTheShare)
{
	const Twice  half(0.6, 0.03, 0.0);
	const double share = denoiseRobustly(half.cloud).doubledShare;
	EXPECT_GT(share, 0.5); // two thirds of all points are on the half that is there twice
	EXPECT_LT(share, 0.75);
}

TEST(DoubledLayers, OneSurfaceIsNotTwo)
{
	for (const double noise : {0.0, 0.1, 0.5, 1.0})
		EXPECT_EQ(denoiseRobustly(Twice(0.0, noise).cloud).doubledShare, 0.0) << noise;
}

// Two sheets that face away from each other are the two sides of a thin wall.
TEST(DoubledLayers, WallsAreNotTwoLayers)
{
	for (const double distance : {1.0, 2.0}) {
		SCOPED_TRACE(distance);
		Twice twice(distance, 0.05);
		for (Index i = 0; i < twice.cloud.size(); ++i)
			if (!twice.upper[i])
				twice.cloud.normals.col(i) *= -1.0;
		EXPECT_LT(denoiseRobustly(twice.cloud).doubledShare, 0.02);
	}
}

TEST(DoubledLayers, RoundedCoordinatesAreNotTwoLayers)
{
	samples::Random random(3, 2);
	PointCloud      wall;
	wall.positions.resize(3, 3000);
	wall.normals = Vector3d::UnitZ().replicate(1, 3000);
	for (Index i = 0; i < 3000; ++i)
		wall.positions.col(i) << random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
			0.012 * std::floor(random.normal3().x() * 0.4);
	EXPECT_EQ(denoiseRobustly(wall).doubledShare, 0.0);
}

TEST(DoubledLayers, SaysNothingOfAHandfulOfPoints)
{
	PointCloud few;
	few.positions = Eigen::Matrix3Xd::Random(3, 50);
	few.normals   = Vector3d::UnitZ().replicate(1, 50);
	EXPECT_EQ(doubledShare(few, few), 0.0);
}

} // namespace
} // namespace curvature_lines::test
