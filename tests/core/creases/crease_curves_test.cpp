// Lengths, normals and sides of creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "crease_curves.h"

namespace curvature_lines {
namespace {

TEST(CreaseCurve, AClosedOneIsLongerByItsLastSide)
{
	CreaseCurve square;
	square.positions.resize(3, 4);
	square.positions << 0, 3, 3, 0, 0, 0, 2, 2, 0, 0, 0, 0;
	EXPECT_DOUBLE_EQ(square.length(), 8.0);
	square.closed = true;
	EXPECT_DOUBLE_EQ(square.length(), 10.0);
	EXPECT_EQ(square.size(), 4);
}

TEST(CreaseCurve, OnePointHasNoLength)
{
	CreaseCurve point;
	point.positions = Eigen::Vector3d(1, 2, 3);
	EXPECT_EQ(point.length(), 0.0);
}

// A right angle between the faces at each of three vertices.
CreaseCurve bent()
{
	CreaseCurve curve;
	curve.left.resize(3, 3);
	curve.right.resize(3, 3);
	curve.left.colwise()  = Eigen::Vector3d(0, 1, 0);
	curve.right.colwise() = Eigen::Vector3d(0, 0, 1);
	curve.angle           = Eigen::Vector3d(1.5, 1.5, -1.0);
	return curve;
}

TEST(CreaseCurve, NormalIsBetweenThoseOfTheFaces)
{
	EXPECT_TRUE(bent().normal(1).isApprox(Eigen::Vector3d(0, 1, 1).normalized(), 1e-15));
}

TEST(CreaseCurve, IsConcaveInTheMean)
{
	CreaseCurve curve = bent();
	EXPECT_FALSE(curve.concave());
	curve.angle[2] = -4.0;
	EXPECT_TRUE(curve.concave());
}

TEST(CreaseTotals, AreThoseOfAllCurvesInTheUnitsWanted)
{
	CreaseCurve open = bent(), loop = bent();
	open.positions.resize(3, 3);
	open.positions << 0, 3, 3, 0, 0, 4, 0, 0, 0;
	loop.positions      = open.positions;
	loop.closed         = true;
	loop.angle          = -loop.angle;
	const Creases both  = {{open, loop}, {}};
	const auto    total = totalsOf(both, 10.0);
	EXPECT_DOUBLE_EQ(total.length, 10.0 * (7.0 + 12.0));
	EXPECT_EQ(total.closed, 1);
	EXPECT_EQ(total.concave, 1);
	EXPECT_DOUBLE_EQ(totalsOf(both).length, 19.0);
}

TEST(CreaseTotals, OfNothingAreZero)
{
	const CreaseTotals none = totalsOf({});
	EXPECT_EQ(none.length, 0.0);
	EXPECT_EQ(none.closed, 0);
	EXPECT_EQ(none.concave, 0);
}

} // namespace
} // namespace curvature_lines
