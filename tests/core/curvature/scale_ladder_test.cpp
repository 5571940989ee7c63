// Radii by the number of points they hold, and the residual of quadrics, on planes of known density and noise.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_ladder.h"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "point_subsets.h"

namespace curvature_lines::test {
namespace {

constexpr double side = 0.7071067811865476; // of a square of diagonal 1

// Independent points, in any order: shuffled. A share of them lies in a tenth of the side.
PointCloud square(Index points, double noise, double denseShare = 0.0)
{
	samples::Random random(11, 0);
	PointCloud      cloud;
	cloud.positions.resize(3, points);
	cloud.normals.resize(3, points);
	for (Index i = 0; i < points; ++i) {
		const double extent = random.uniform() < denseShare ? 0.1 * side : side;
		cloud.positions.col(i) << extent * random.uniform(), extent * random.uniform(),
			noise * random.normal3().x();
		cloud.normals.col(i) = Eigen::Vector3d::UnitZ();
	}
	return cloud;
}

TEST(ScaleLadder, BeginsWhereBallsHoldEnoughPoints)
{
	for (const Index points : {1000, 8000}) {
		const PointSample sample(square(points, 0.0));
		const ScaleLadder ladder = scaleLadder(sample);
		// 42 points, the middle one among them, of density points / side^2; balls at the rim are larger.
		const double radius = side * std::sqrt(42.0 / (EIGEN_PI * points));
		EXPECT_GT(ladder.usualRadius, 0.95 * radius);
		EXPECT_LT(ladder.usualRadius, 1.2 * radius);
		EXPECT_EQ(ladder.smallestRadius, ladder.usualRadius);
		EXPECT_EQ(ladder.radius(0), ladder.smallestRadius);
		EXPECT_NEAR(ladder.radius(3) / ladder.radius(2), ladderStep, 1e-12);
		EXPECT_LE(ladder.radius(ladder.levels - 1), 0.22);
		EXPECT_GT(ladder.radius(ladder.levels), 0.22);
		EXPECT_GT(ladder.middleRadius(), ladder.usualRadius);
		EXPECT_LT(ladder.middleRadius(), 0.22);
	}
}

TEST(ScaleLadder, HasFinerLevelsForDenseParts)
{
	const PointSample sample(square(6000, 0.0, 0.25));
	const ScaleLadder ladder = scaleLadder(sample);
	// The dense part is 34 times as dense as the rest: radii are almost 6 times smaller there.
	EXPECT_LT(ladder.smallestRadius, 0.3 * ladder.usualRadius);
	EXPECT_GT(ladder.smallestRadius, 0.1 * ladder.usualRadius);
}

TEST(ScaleLadder, HasALevelWhateverTheCloud)
{
	const PointSample one(square(1, 0.0)), few(square(9, 0.0));
	EXPECT_GE(scaleLadder(one).levels, 1);
	EXPECT_GE(scaleLadder(few).levels, 1);
}

TEST(ScaleLadder, QuadricResidualIsTheNoise)
{
	const PointSample exact(square(4000, 0.0));
	EXPECT_LT(quadricResidual(exact, scaleLadder(exact)), 1e-9);
	for (const double noise : {0.001, 0.004, 0.016}) {
		const PointSample sample(square(4000, noise));
		const double      found = quadricResidual(sample, scaleLadder(sample));
		EXPECT_GT(found, 0.75 * noise) << noise; // a lower quantile
		EXPECT_LT(found, 1.05 * noise) << noise;
	}
}

} // namespace
} // namespace curvature_lines::test
