// Lengths, segments and points of open, closed and very short polylines.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "line_network.h"
#include "line_networks.h"

namespace curvature_lines::tests {
namespace {

using Eigen::Vector3d;

LineNetwork circleAndSegment()
{
	NetworkBuilder builder(planeNormal());
	builder.add(1, true, 100, [](double t) {
		return Vector3d(std::cos(2 * Pi * t), std::sin(2 * Pi * t), 0.0);
	});
	builder.addSegment(2, {0, 0, 0}, {3, 4, 0}, 5);
	return builder.lines();
}

TEST(LineNetwork, ArcLengthsStartAgainWithEveryLine)
{
	const LineNetwork     lines = circleAndSegment();
	const Eigen::VectorXd arc   = arcLengths(lines);
	ASSERT_EQ(arc.size(), 106);
	EXPECT_EQ(arc[0], 0.0);
	EXPECT_NEAR(arc[99], 99.0 * 2.0 * std::sin(Pi / 100.0), 1e-9);
	for (int k = 0; k <= 5; ++k)
		EXPECT_NEAR(arc[100 + k], k, 1e-12);
}

TEST(LineNetwork, ClosedLinesHaveOneSegmentMore)
{
	LineNetwork lines = circleAndSegment();
	EXPECT_EQ(segmentCount(lines, 0), 100);
	EXPECT_EQ(segmentCount(lines, 1), 5);
	EXPECT_TRUE(isClosed(lines, 0));
	EXPECT_FALSE(isClosed(lines, 1));
	// Two vertices are too few to be closed, one is no segment.
	lines.offsets = {0, 2, 3};
	lines.closed  = {1, 0};
	EXPECT_FALSE(isClosed(lines, 0));
	EXPECT_EQ(segmentCount(lines, 0), 1);
	EXPECT_EQ(segmentCount(lines, 1), 0);
}

TEST(LineNetwork, PointsBetweenVertices)
{
	const LineNetwork lines = circleAndSegment();
	EXPECT_LT((pointOnLine(lines, 1, 2.5) - Vector3d(1.5, 2.0, 0.0)).norm(), 1e-12);
	EXPECT_LT((pointOnLine(lines, 1, 5.0) - Vector3d(3, 4, 0)).norm(), 1e-12);
	// From the last vertex of the circle back to its first.
	const Vector3d back = 0.5 * (lines.vertices.col(99) + lines.vertices.col(0));
	EXPECT_LT((pointOnLine(lines, 0, 99.5) - back).norm(), 1e-12);
	EXPECT_LT((pointOnLine(lines, 0, 100.0) - lines.vertices.col(0)).norm(), 1e-12);
}

} // namespace
} // namespace curvature_lines::tests
