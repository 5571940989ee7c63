// Coordinates rounded to steps are spread over them; others stay as they are.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinate_steps.h"

#include <cmath>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;

// A wall of random points, one per unit square, with noise in depth.
Matrix3Xd wall(double noise, int n = 2500)
{
	samples::Random random(3, 0);
	const double    side = std::sqrt(double(n));
	Matrix3Xd       points(3, n);
	for (auto p : points.colwise())
		p << random.uniform(0.0, side), random.uniform(0.0, side), noise * random.normal();
	return points;
}

Matrix3Xd rounded(Matrix3Xd points, double step)
{
	points.row(2) = ((points.row(2).array() / step).round() * step).matrix();
	return points;
}

double deviationOfDepth(const Matrix3Xd& points)
{
	return std::sqrt((points.row(2).array() - points.row(2).mean()).square().mean());
}

TEST(CoordinateSteps, StepsAreFoundAndTheDeviationIsThatBeforeRounding)
{
	for (const double step : {0.3, 0.7, 1.5}) {
		SCOPED_TRACE(step);
		const double            noise  = 0.7;
		const SpreadCoordinates spread = spreadOverSteps(rounded(wall(noise), step), 1.0);
		EXPECT_TRUE(spread.any());
		EXPECT_NEAR(spread.steps.z(), step, 1e-9);
		EXPECT_EQ(spread.steps.head<2>().norm(), 0.0);
		EXPECT_NEAR(deviationOfDepth(spread.positions), noise, 0.2 * noise);
		// Nobody leaves the interval that is rounded to the same value; the outermost may be wider.
		const Matrix3Xd moved = spread.positions - rounded(wall(noise), step);
		EXPECT_EQ(moved.topRows(2).norm(), 0.0);
		EXPECT_LE(moved.cwiseAbs().maxCoeff(), 0.75 * step + 1e-12);
	}
}

TEST(CoordinateSteps, WhatIsNotSteppedStays)
{
	EXPECT_FALSE(spreadOverSteps(wall(0.7), 1.0).any());
	EXPECT_EQ(spreadOverSteps(wall(0.7), 1.0).positions, wall(0.7));
	EXPECT_FALSE(spreadOverSteps(rounded(wall(0.7), 0.01), 1.0).any()) << "too fine to matter";
	EXPECT_FALSE(spreadOverSteps(rounded(wall(9.0), 5.0), 1.0).any()) << "slices";
	EXPECT_FALSE(spreadOverSteps(rounded(wall(0.0), 0.7), 1.0).any()) << "a plane is one value";
	// A cube has two values on a third of its points.
	Matrix3Xd  cube     = samples::generate({}).positions;
	const auto original = cube;
	EXPECT_FALSE(spreadOverSteps(cube, 0.05).any());
	EXPECT_EQ(cube, original);
}

TEST(CoordinateSteps, EachPointForItself)
{
	const Matrix3Xd         points    = rounded(wall(0.7), 0.7);
	const SpreadCoordinates here      = spreadOverSteps(points, 1.0);
	const SpreadCoordinates backwards = spreadOverSteps(points.rowwise().reverse(), 1.0);
	EXPECT_EQ(here.positions, Matrix3Xd(backwards.positions.rowwise().reverse()));
}

TEST(CoordinateSteps, FewPointsAreNoError)
{
	for (const int n : {0, 1, 2, 20})
		EXPECT_EQ(spreadOverSteps(Matrix3Xd::Zero(3, n), 1.0).positions.cols(), n);
}

} // namespace
} // namespace curvature_lines
