// Distances between lines: the chord of a circle, bounds, gradation and the epsilon for a number of crossings.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "line_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

test::ExactCloud exact(const char* surface, int points)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.seed    = 5;
	return test::exactCloud(request);
}

LineSpacing
chosen(const test::ExactCloud& cloud, const LineSpacingOptions& options, double crossings = 0.0)
{
	return chooseLineSpacing(cloud.cloud, cloud.field, cloud.minimum, options, crossings);
}

TEST(LineSpacing, IsTheChordOfThatSagitta)
{
	for (const double radius : {0.5, 2.0, 10.0})
		for (const double eps : {1e-4, 1e-2, 0.1}) {
			const double chord = lineSpacing(1.0 / radius, eps, 0.0, 1e9);
			EXPECT_NEAR(radius - std::sqrt(radius * radius - 0.25 * chord * chord), eps, 1e-9);
			EXPECT_EQ(lineSpacing(-1.0 / radius, eps, 0.0, 1e9), chord);
		}
	EXPECT_EQ(lineSpacing(0.0, 0.01, 0.1, 0.7), 0.7); // flat
	EXPECT_EQ(lineSpacing(1e9, 0.01, 0.1, 0.7), 0.1); // a needle
	EXPECT_NEAR(
		lineSpacing(1.0, 5.0, 0.0, 9.0), 2.0, 1e-12); // no chord is longer than the diameter
}

TEST(LineSpacing, OfASphereIsTheSameEverywhere)
{
	const auto         cloud = exact("sphere", 3000);
	LineSpacingOptions options;
	options.epsilon                 = 3e-3;
	const LineSpacing chosenSpacing = chosen(cloud, options);
	EXPECT_NEAR(chosenSpacing.diagonal, std::sqrt(12.0), 0.05);
	EXPECT_EQ(chosenSpacing.epsilon, 3e-3);
	const double expected = lineSpacing(1.0, 3e-3 * chosenSpacing.diagonal, 0.0, 9.0);
	for (const auto& family : chosenSpacing.distance)
		for (const double d : family)
			EXPECT_NEAR(d, expected, 1e-9);
}

TEST(LineSpacing, KeepsToTheBoundsAndIsGraded)
{
	const auto         cloud = exact("torus", 3000);
	LineSpacingOptions options;
	options.epsilon           = 1e-3;
	options.minSpacing        = 0.16;
	options.maxSpacing        = 0.30;
	options.gradation         = 0.5;
	const LineSpacing spacing = chosen(cloud, options);
	const double      eps     = options.epsilon * spacing.diagonal;
	for (int f = 0; f < 2; ++f) {
		const Eigen::VectorXd& across = f == 0 ? cloud.field.k2 : cloud.field.k1;
		for (Index i = 0; i < cloud.cloud.size(); ++i) {
			const double d = spacing.distance[f][i];
			EXPECT_GE(d, 0.16);
			EXPECT_LE(d, 0.30);
			EXPECT_LE(d, lineSpacing(across[i], eps, 0.16, 0.30) + 1e-12);
			for (const Index j : cloud.minimum.neighbors[i])
				EXPECT_LE(
					spacing.distance[f][j],
					d + 0.5 * (cloud.cloud.positions.col(i) - cloud.cloud.positions.col(j)).norm() +
						1e-12);
		}
	}
}

TEST(LineSpacing, MoreCrossingsNeedASmallerEpsilon)
{
	const auto cloud  = exact("torus", 3000);
	double     before = 1.0, distance = 1e9;
	for (const double crossings : {50.0, 200.0, 800.0}) {
		const LineSpacing spacing = chosen(cloud, {}, crossings);
		EXPECT_LT(spacing.epsilon, before);
		double mean = 0.0;
		for (const double d : spacing.distance[0])
			mean += d / spacing.distance[0].size();
		EXPECT_LT(mean, distance);
		before   = spacing.epsilon;
		distance = mean;
	}
}

TEST(LineSpacing, ScalesWithTheCloud)
{
	const auto cloud = exact("ellipsoid", 1500);
	auto       large = cloud;
	large.cloud.positions *= 4.0;
	large.field.k1 /= 4.0;
	large.field.k2 /= 4.0;
	large.minimum       = minimumNeighborhoods(large.cloud, NeighborSearch(large.cloud.positions));
	const LineSpacing a = chosen(cloud, {}, 300.0), b = chosen(large, {}, 300.0);
	EXPECT_NEAR(b.epsilon, a.epsilon, 1e-3 * a.epsilon);
	for (Index i = 0; i < cloud.cloud.size(); ++i)
		EXPECT_NEAR(b.distance[0][i], 4.0 * a.distance[0][i], 1e-3 * b.distance[0][i]);
}

} // namespace
} // namespace curvature_lines
