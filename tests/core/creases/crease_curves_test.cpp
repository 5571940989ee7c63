// Lengths of creases.
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

} // namespace
} // namespace curvature_lines
