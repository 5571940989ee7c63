// Lines of a plane that cross: what is cut, and that nothing else is.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_untangling.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "line_network.h"
#include "line_networks.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using tests::crossingsWithinFamilies;

tests::NetworkBuilder plane()
{
	return tests::NetworkBuilder([](const Vector3d&) { return Vector3d(0.0, 0.0, 1.0); });
}

TEST(LineUntangling, LeavesLinesThatDoNotCross)
{
	const LineNetwork lines = plane()
	                              .addSegment(1, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 10)
	                              // the other family
	                              .addSegment(2, {0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}, 10)
	                              .lines();
	const LineNetwork same = untangled(lines);
	EXPECT_EQ(same.vertices, lines.vertices);
	EXPECT_EQ(same.offsets, lines.offsets);
}

TEST(LineUntangling, EndsTheLineThatLosesLeast)
{
	const LineNetwork lines = plane()
	                              .addSegment(1, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 10)
	                              .addSegment(1, {0.55, -0.9, 0.0}, {0.55, 0.15, 0.0}, 10)
	                              .lines();
	ASSERT_EQ(crossingsWithinFamilies(lines), 1);
	const LineNetwork cut = untangled(lines);
	EXPECT_EQ(crossingsWithinFamilies(cut), 0);
	ASSERT_EQ(cut.lines(), 2);
	EXPECT_EQ(cut.offsets[1], 11);
	EXPECT_EQ(cut.offsets[2], 11 + 9); // without the two vertices behind the crossing
	EXPECT_EQ(cut.ends[1][1], LineEnd::Line);
}

TEST(LineUntangling, TakesLoopsOut)
{
	const auto loop = [](double s) { // once around on the way
		const double x     = 2.0 * s - 1.0,
					 angle = 2.0 * tests::Pi * std::clamp(2.5 * (s - 0.3), 0.0, 1.0);
		return Vector3d(x + 0.6 * std::sin(angle), 0.2 * (1.0 - std::cos(angle)), 0.0);
	};
	const LineNetwork lines = plane().add(1, false, 60, loop).lines();
	ASSERT_EQ(crossingsWithinFamilies(lines), 1);
	const LineNetwork cut = untangled(lines);
	EXPECT_EQ(crossingsWithinFamilies(cut), 0);
	EXPECT_EQ(cut.lines(), 1);
	EXPECT_NEAR(cut.vertices(0, 0), -1.0, 1e-12);
	EXPECT_NEAR(cut.vertices.rightCols<1>()(0), 1.0, 1e-12);
}

TEST(LineUntangling, ClosedLinesStayClosedWithoutTheirLoop)
{
	const auto eight = [](double s) { // a circle with a small one behind the crossing
		const double angle = 2.0 * tests::Pi * s;
		return Vector3d(
			std::cos(angle) + 0.7 * std::cos(2.0 * angle),
			std::sin(angle) + 0.7 * std::sin(2.0 * angle),
			0.0);
	};
	const LineNetwork lines = plane().add(1, true, 60, eight).lines();
	ASSERT_EQ(crossingsWithinFamilies(lines), 1);
	const LineNetwork cut = untangled(lines);
	EXPECT_EQ(crossingsWithinFamilies(cut), 0);
	ASSERT_EQ(cut.lines(), 1);
	EXPECT_TRUE(cut.closed[0]);
	EXPECT_GT(cut.vertices.cols(), 30);
}

TEST(LineUntangling, OpensARingOnlyWhereTwoRingsCross)
{
	const auto ring = [](double x) {
		return [x](double s) {
			const double angle = 2.0 * tests::Pi * (s + 0.01);
			return Vector3d(x + std::cos(angle), std::sin(angle), 0.0);
		};
	};
	const LineNetwork lines =
		plane().add(1, true, 40, ring(0.0)).add(1, true, 50, ring(0.5)).lines();
	ASSERT_EQ(crossingsWithinFamilies(lines), 2);
	const LineNetwork cut = untangled(lines);
	EXPECT_EQ(crossingsWithinFamilies(cut), 0);
	ASSERT_EQ(cut.lines(), 2);
	EXPECT_FALSE(cut.closed[0]);
	EXPECT_TRUE(cut.closed[1]);
}

} // namespace
} // namespace curvature_lines
