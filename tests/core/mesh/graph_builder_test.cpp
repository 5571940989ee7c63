// Graphs put together vertex by vertex: half-edges, straight edges between vertices, and both embeddings.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "graph_builder.h"
#include "half_edge_graph.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// A cross of four arms of length 1 whose ends are joined to a square.
struct Wheel {
	GraphBuilder       builder;
	Index              centre = builder.addVertex(Vector3d::Zero(), Vector3d::UnitZ());
	std::vector<Index> ends, spokes, sides;

	Wheel()
	{
		for (const Vector3d& p :
		     {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(-1, 0, 0), Vector3d(0, -1, 0)})
			ends.push_back(builder.addVertex(p, Vector3d::UnitZ()));
		for (const Index end : ends)
			spokes.push_back(builder.addEdge(centre, end));
		sides = builder.addPath({ends[0], ends[1], ends[2], ends[3], ends[0]});
	}
};

TEST(GraphBuilder, EdgesAreStraightAndKnowBothEnds)
{
	Wheel wheel;
	EXPECT_EQ(wheel.builder.vertexCount(), 5);
	EXPECT_EQ(wheel.builder.edgeCount(), 8);
	for (std::size_t k = 0; k < 4; ++k) {
		const HalfEdgeGraph::Edge& spoke = wheel.builder.edgeOf(wheel.spokes[k]);
		const Vector3d             end   = wheel.builder.position(wheel.ends[k]);
		EXPECT_EQ(spoke.from, wheel.centre);
		EXPECT_EQ(spoke.to, wheel.ends[k]);
		EXPECT_LT((spoke.tangentFrom - end).norm(), 1e-12);
		EXPECT_LT((spoke.tangentTo + end).norm(), 1e-12);
		EXPECT_LT((spoke.middle - 0.5 * end).norm(), 1e-12);
		EXPECT_LT((spoke.middleNormal - Vector3d::UnitZ()).norm(), 1e-12);
		EXPECT_FALSE(spoke.isFeature);
	}
	wheel.builder.edgeOf(wheel.sides[0]).isFeature = true;
	EXPECT_TRUE(wheel.builder.graph().edge(wheel.sides[0] >> 1).isFeature);
}

TEST(GraphBuilder, APathLeavesItsVerticesForwards)
{
	const Wheel         wheel;
	const HalfEdgeGraph graph = wheel.builder.graph();
	ASSERT_EQ(wheel.sides.size(), 4u);
	for (std::size_t k = 0; k < 4; ++k) {
		EXPECT_EQ(graph.origin(wheel.sides[k]), wheel.ends[k]);
		EXPECT_EQ(graph.origin(HalfEdgeGraph::twin(wheel.sides[k])), wheel.ends[(k + 1) % 4]);
	}
}

TEST(GraphBuilder, TangentsSortTheHalfEdges)
{
	const Wheel         wheel;
	const HalfEdgeGraph graph  = wheel.builder.graph();
	const auto&         around = graph.around(wheel.centre);
	ASSERT_EQ(around.size(), 4u);
	for (std::size_t k = 0; k < 4; ++k) {
		const Vector3d a = graph.tangent(around[k]), b = graph.tangent(around[(k + 1) % 4]);
		EXPECT_GT(a.cross(b).z(), 0.9); // counter-clockwise
	}
	EXPECT_EQ(graph.faceLoops().size(), 5u); // four triangles and the outside
	EXPECT_EQ(graph.eulerCharacteristic(), 2);
}

TEST(GraphBuilder, AnExactEmbeddingIsTakenAsGiven)
{
	const Wheel                     wheel;
	const HalfEdgeGraph             sorted = wheel.builder.graph();
	std::vector<std::vector<Index>> around;
	for (Index v = 0; v < sorted.vertexCount(); ++v)
		around.push_back(sorted.around(v));
	std::swap(around[wheel.centre][0], around[wheel.centre][1]); // no longer of the plane
	const HalfEdgeGraph twisted = wheel.builder.graph(around, std::vector<char>(5, 0));
	EXPECT_EQ(twisted.around(wheel.centre), around[wheel.centre]);
	EXPECT_LT(twisted.eulerCharacteristic(), 2);
}

TEST(GraphBuilder, NothingIsAnEmptyGraph)
{
	const HalfEdgeGraph graph = GraphBuilder().graph();
	EXPECT_EQ(graph.vertexCount(), 0);
	EXPECT_EQ(graph.edgeCount(), 0);
	EXPECT_TRUE(graph.faceLoops().empty());
}

} // namespace
} // namespace curvature_lines
