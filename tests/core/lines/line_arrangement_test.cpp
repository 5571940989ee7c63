// Arrangements of lines whose crossings are known: grids in the plane, circles of a torus, great circles of a
// sphere.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>

#include <gtest/gtest.h>

#include "half_edge_graph.h"
#include "line_arrangement.h"
#include "line_intersections.h"
#include "line_network.h"
#include "line_networks.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using namespace tests;
using Eigen::Vector3d;

LineArrangement arrangementOf(const PointCloud& cloud, const LineNetwork& lines)
{
	const VoronoiCells cells(cloud.positions);
	return arrangeLines(cells, lines, intersectLines(cells, lines));
}

Index livingEdges(const HalfEdgeGraph& graph)
{
	Index count = 0;
	for (Index e = 0; e < graph.edgeCount(); ++e)
		count += graph.alive(e);
	return count;
}

TEST(LineArrangement, OfAGridHasItsCells)
{
	NetworkBuilder builder(planeNormal());
	for (int k = 0; k < 5; ++k) {
		const double at = -0.4 + 0.2 * k;
		builder.addSegment(1, {-0.45, at, 0}, {0.45, at + 0.01, 0}, 30);
		builder.addSegment(2, {at, -0.45, 0}, {at + 0.01, 0.45, 0}, 30);
	}
	const LineArrangement found = arrangementOf(sampleCloud("plane", 2000, 3), builder.lines());
	EXPECT_EQ(found.merged, 0);
	// 4 x 4 cells and the outside; the corners, where two edges meet, are no vertices any more
	const auto loops = found.graph.faceLoops();
	EXPECT_EQ(loops.size(), 17u);
	EXPECT_EQ(found.graph.eulerCharacteristic(), 2);
	EXPECT_GE(livingEdges(found.graph), 36);
	for (Index v = 0; v < found.graph.vertexCount(); ++v)
		if (!found.graph.around(v).empty()) {
			EXPECT_GE(found.graph.around(v).size(), 2u);
			EXPECT_LE(found.graph.around(v).size(), 4u);
			EXPECT_NEAR(found.graph.positions()(2, v), 0.0, 1e-9);
		}
}

TEST(LineArrangement, OfCirclesOnATorusIsItsQuads)
{
	const LineArrangement found =
		arrangementOf(sampleCloud("torus", 3000, 3), torusNetwork(12, 8, 60, 0.0, 1));
	EXPECT_EQ(found.merged, 0);
	EXPECT_EQ(found.graph.eulerCharacteristic(), 0);
	const auto loops = found.graph.faceLoops();
	EXPECT_EQ(loops.size(), 96u);
	for (const auto& loop : loops)
		EXPECT_EQ(loop.size(), 4u);
	EXPECT_EQ(livingEdges(found.graph), 192);
}

// Noise, and circles whose crossings are close together.
TEST(LineArrangement, OfGreatCirclesKeepsTheEulerCharacteristic)
{
	for (const std::uint64_t seed : {1, 2, 3}) {
		const LineArrangement found =
			arrangementOf(sampleCloud("sphere", 3000, 3), greatCircles(9, 90, 0.002, seed));
		EXPECT_EQ(found.graph.eulerCharacteristic(), 2) << seed;
	}
}

TEST(LineArrangement, LinesThatCrossNothingLeaveNothing)
{
	NetworkBuilder builder(planeNormal());
	builder.addSegment(1, {-0.4, 0.1, 0}, {0.4, 0.1, 0}, 20);
	builder.addSegment(1, {-0.4, -0.1, 0}, {0.4, -0.1, 0}, 20);
	const LineArrangement found = arrangementOf(sampleCloud("plane", 1000, 3), builder.lines());
	EXPECT_EQ(livingEdges(found.graph), 0);
	EXPECT_TRUE(found.graph.faceLoops().empty());
}

} // namespace
} // namespace curvature_lines
