// The colour convention of Rusinkiewicz 2004: convex red, saddle green, concave blue, flat white.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_colors.h"

#include <algorithm>

#include <gtest/gtest.h>

using namespace curvature_lines;

namespace {

Eigen::Vector3d colorOf(double k1, double k2)
{
	// Others in the cloud set the scale: the 10th percentile of |k| is 10.
	Eigen::VectorXd a = Eigen::VectorXd::Constant(50, 10.0), b = a;
	a[7] = k1;
	b[7] = k2;
	return curvatureColors(a, b, 1.0).col(7);
}

} // namespace

TEST(CurvatureColors, ConvexIsRedSaddleGreenConcaveBlue)
{
	const Eigen::Vector3d convex = colorOf(20, 20), saddle = colorOf(20, -20),
						  concave = colorOf(-20, -20);
	EXPECT_DOUBLE_EQ(convex[0], 1.0);
	EXPECT_LT(std::max(convex[1], convex[2]), 1.0);
	EXPECT_NEAR(convex[1], convex[2], 1e-12);
	EXPECT_DOUBLE_EQ(saddle[1], 1.0);
	EXPECT_NEAR(saddle[0], saddle[2], 1e-12);
	EXPECT_DOUBLE_EQ(concave[2], 1.0);
	EXPECT_NEAR(concave[0], concave[1], 1e-12);
}

TEST(CurvatureColors, FlatIsWhiteAndMoreBentIsMoreSaturated)
{
	EXPECT_TRUE(colorOf(0, 0).isApprox(Eigen::Vector3d::Ones()));
	EXPECT_GT(colorOf(2, 2)[1], colorOf(40, 40)[1]);
}

TEST(CurvatureColors, ScaleOfTheModelDoesNotMatter)
{
	Eigen::VectorXd k1(4), k2(4);
	k1 << 3, 4, 5, 6;
	k2 << 1, -4, 2, 0;
	const Eigen::Matrix3Xd unit = curvatureColors(k1, k2, 1.0);
	EXPECT_TRUE(curvatureColors(k1 * 1e6, k2 * 1e6, 1e-6).isApprox(unit, 1e-12));
}

TEST(CurvatureColors, AllFlatAndEmptyAreFine)
{
	const Eigen::VectorXd zero = Eigen::VectorXd::Zero(5);
	EXPECT_TRUE(curvatureColors(zero, zero, 1.0).isApprox(Eigen::Matrix3Xd::Ones(3, 5)));
	EXPECT_EQ(curvatureColors({}, {}, 1.0).cols(), 0);
}
