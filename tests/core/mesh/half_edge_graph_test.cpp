// Face loops of known graphs and reductions that must keep the Euler number.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_edge_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Edge = HalfEdgeGraph::Edge;

constexpr double Pi = 3.14159265358979323846;

Edge straight(const Matrix3Xd& p, const Matrix3Xd& n, Index a, Index b)
{
	const Vector3d d = p.col(b) - p.col(a);
	return {a, b, d, -d, 0.5 * (p.col(a) + p.col(b)), (n.col(a) + n.col(b)).normalized()};
}

HalfEdgeGraph straightGraph(
	const Matrix3Xd& p, const Matrix3Xd& n, const std::vector<std::pair<Index, Index>>& pairs)
{
	std::vector<Edge> edges;
	for (const auto& [a, b] : pairs)
		edges.push_back(straight(p, n, a, b));
	return HalfEdgeGraph(p, n, edges);
}

Index liveEdges(const HalfEdgeGraph& graph)
{
	Index count = 0;
	for (Index e = 0; e < graph.edgeCount(); ++e)
		count += graph.alive(e);
	return count;
}

// Rows of latitude without the poles, joined to one vertex at each pole; directions of the sphere
// as normals.
struct SphereGrid {
	Matrix3Xd                            points;
	std::vector<std::pair<Index, Index>> pairs;

	SphereGrid(Index rows, Index columns) : points(3, rows * columns + 2)
	{
		const Index south = rows * columns, north = south + 1;
		points.col(south) = -Vector3d::UnitZ();
		points.col(north) = Vector3d::UnitZ();
		for (Index r = 0; r < rows; ++r) {
			for (Index c = 0; c < columns; ++c) {
				const double v = Pi * ((r + 1.0) / (rows + 1) - 0.5), u = 2 * Pi * c / columns;
				const Index  i = r * columns + c;
				points.col(i) =
					Vector3d(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
				pairs.emplace_back(i, r * columns + (c + 1) % columns);
				pairs.emplace_back(r == 0 ? south : i - columns, i);
			}
		}
		for (Index c = 0; c < columns; ++c)
			pairs.emplace_back((rows - 1) * columns + c, north);
	}
};

// Removes random edges between two different loops, so that the graph of a sphere stays connected.
void removeAtRandom(HalfEdgeGraph& graph, Index count, unsigned seed)
{
	std::mt19937 random(seed);
	for (Index tries = 0; tries < 20 * count && count > 0; ++tries) {
		const Index e = static_cast<Index>(random() % static_cast<unsigned>(graph.edgeCount()));
		if (!graph.alive(e))
			continue;
		bool bridge = false;
		for (const std::vector<Index>& loop : graph.faceLoops())
			bridge = bridge || (std::count(loop.begin(), loop.end(), 2 * e) &&
			                    std::count(loop.begin(), loop.end(), 2 * e + 1));
		if (!bridge) {
			graph.removeEdge(e);
			--count;
		}
	}
}

bool everyHalfEdgeIsInOneLoop(const HalfEdgeGraph& graph)
{
	std::vector<Index> seen;
	for (const std::vector<Index>& loop : graph.faceLoops()) {
		for (std::size_t k = 0; k < loop.size(); ++k) {
			seen.push_back(loop[k]);
			const Index next = loop[(k + 1) % loop.size()];
			if (graph.origin(next) != graph.origin(HalfEdgeGraph::twin(loop[k])))
				return false;
		}
	}
	std::sort(seen.begin(), seen.end());
	return std::adjacent_find(seen.begin(), seen.end()) == seen.end() &&
	       static_cast<Index>(seen.size()) == 2 * liveEdges(graph);
}

TEST(HalfEdgeGraph, CubeHasSixSquares)
{
	Matrix3Xd points(3, 8);
	for (Index i = 0; i < 8; ++i)
		points.col(i) = Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
	std::vector<std::pair<Index, Index>> pairs;
	for (Index i = 0; i < 8; ++i)
		for (const Index bit : {1, 2, 4})
			if (!(i & bit))
				pairs.emplace_back(i, i | bit);
	const HalfEdgeGraph graph = straightGraph(points, points.colwise().normalized(), pairs);

	EXPECT_EQ(graph.eulerCharacteristic(), 2);
	EXPECT_TRUE(everyHalfEdgeIsInOneLoop(graph));
	const auto loops = graph.faceLoops();
	ASSERT_EQ(loops.size(), 6u);
	for (const std::vector<Index>& loop : loops) {
		ASSERT_EQ(loop.size(), 4u);
		// Counter-clockwise seen from outside: the area vector points away from the centre.
		Vector3d area = Vector3d::Zero(), center = Vector3d::Zero();
		for (std::size_t k = 0; k < 4; ++k) {
			const Vector3d a = points.col(graph.origin(loop[k]));
			area += a.cross(Vector3d(points.col(graph.origin(loop[(k + 1) % 4]))));
			center += a;
		}
		EXPECT_GT(area.dot(center), 0.0);
	}
}

TEST(HalfEdgeGraph, TorusGridHasOneQuadPerVertex)
{
	const Index                          n = 12, m = 7;
	Matrix3Xd                            points(3, n * m), normals(3, n * m);
	std::vector<std::pair<Index, Index>> pairs;
	for (Index i = 0; i < n; ++i) {
		for (Index j = 0; j < m; ++j) {
			const double   u = 2 * Pi * i / n, v = 2 * Pi * j / m;
			const Vector3d radial(std::cos(u), std::sin(u), 0.0);
			normals.col(i * m + j) = std::cos(v) * radial + std::sin(v) * Vector3d::UnitZ();
			points.col(i * m + j)  = radial + 0.4 * normals.col(i * m + j);
			pairs.emplace_back(i * m + j, (i + 1) % n * m + j);
			pairs.emplace_back(i * m + j, i * m + (j + 1) % m);
		}
	}
	const HalfEdgeGraph graph = straightGraph(points, normals, pairs);
	EXPECT_EQ(graph.eulerCharacteristic(), 0);
	const auto loops = graph.faceLoops();
	EXPECT_EQ(loops.size(), static_cast<std::size_t>(n * m));
	for (const std::vector<Index>& loop : loops)
		EXPECT_EQ(loop.size(), 4u);
}

TEST(HalfEdgeGraph, DanglingEdgesOfAPlanarGridAreCut)
{
	const Index n = 5;
	Matrix3Xd   points(3, 2 * n * n), normals(3, 2 * n * n);
	normals.colwise() = Vector3d::UnitZ();
	std::vector<std::pair<Index, Index>> pairs;
	for (Index i = 0; i < n * n; ++i) {
		points.col(i) = Vector3d(i % n, i / n, 0.0);
		if (i % n + 1 < n)
			pairs.emplace_back(i, i + 1);
		if (i / n + 1 < n)
			pairs.emplace_back(i, i + n);
		// A stub of two edges in every other cell, pointing inside it or away from the grid.
		points.col(n * n + i) = points.col(i) + Vector3d(0.3, 0.2, 0.0) * (1 + i % 2);
		if (i % 2 == 0) {
			pairs.emplace_back(i, n * n + i);
			if (i + 1 < n * n)
				pairs.emplace_back(n * n + i, n * n + i + 1);
		}
	}
	HalfEdgeGraph graph = straightGraph(points, normals, pairs);
	EXPECT_EQ(graph.eulerCharacteristic(), 2); // of the plane with a point at infinity
	EXPECT_TRUE(graph.cutDanglingEdges());
	EXPECT_FALSE(graph.cutDanglingEdges());
	EXPECT_EQ(graph.eulerCharacteristic(), 2);
	EXPECT_EQ(liveEdges(graph), 2 * n * (n - 1));
	EXPECT_EQ(graph.faceLoops().size(), static_cast<std::size_t>((n - 1) * (n - 1) + 1));
}

TEST(HalfEdgeGraph, EveryReductionKeepsTheEulerNumber)
{
	for (unsigned seed = 1; seed <= 20; ++seed) {
		const SphereGrid  grid(7, 9);
		std::vector<Edge> edges;
		std::mt19937      random(seed);
		for (const auto& [a, b] : grid.pairs) {
			edges.push_back(straight(grid.points, grid.points, a, b));
			// Some edges doubled: beside the first by a small angle at both ends, so that they
			// bound a digon.
			if (random() % 5 == 0) {
				Edge           twice = edges.back();
				const Vector3d aside = 0.02 * twice.middle.cross(twice.tangentFrom).normalized();
				twice.tangentFrom += aside;
				twice.tangentTo += aside;
				twice.middle += (random() % 2 ? 1.0 : 20.0) * aside;
				edges.push_back(twice);
			}
		}
		HalfEdgeGraph graph(grid.points, grid.points, edges);
		ASSERT_EQ(graph.eulerCharacteristic(), 2);
		removeAtRandom(graph, 60, seed);
		ASSERT_EQ(graph.eulerCharacteristic(), 2);
		graph.dissolveDegreeTwo();
		EXPECT_EQ(graph.eulerCharacteristic(), 2);
		graph.removeDigons();
		EXPECT_EQ(graph.eulerCharacteristic(), 2);
		graph.cutDanglingEdges();
		EXPECT_EQ(graph.eulerCharacteristic(), 2);
		graph.reduce();
		EXPECT_EQ(graph.eulerCharacteristic(), 2);
		graph.separateParallelEdges();
		EXPECT_EQ(graph.eulerCharacteristic(), 2);
		EXPECT_TRUE(everyHalfEdgeIsInOneLoop(graph));

		std::set<std::pair<Index, Index>> seen;
		for (Index e = 0; e < graph.edgeCount(); ++e) {
			if (!graph.alive(e))
				continue;
			const auto [low, high] = std::minmax(graph.edge(e).from, graph.edge(e).to);
			EXPECT_NE(low, high);
			EXPECT_TRUE(seen.emplace(low, high).second);
		}
		for (Index v = 0; v < graph.vertexCount(); ++v)
			EXPECT_NE(graph.around(v).size(), 1u);
	}
}

TEST(HalfEdgeGraph, StraightVerticesDissolveAndCornersStay)
{
	Matrix3Xd points(3, 8), normals(3, 8);
	normals.colwise() = Vector3d::UnitZ();
	std::vector<std::pair<Index, Index>> pairs; // a square with a vertex in the middle of each side
	for (Index i = 0; i < 8; ++i) {
		const double a = 2 * Pi * i / 8, r = i % 2 ? 1.0 : std::sqrt(2.0);
		points.col(i) = Vector3d(r * std::cos(a), r * std::sin(a), 0.0);
		pairs.emplace_back(i, (i + 1) % 8);
	}
	HalfEdgeGraph graph = straightGraph(points, normals, pairs);
	graph.reduce();
	EXPECT_EQ(liveEdges(graph), 4);
	for (Index v = 0; v < 8; ++v)
		EXPECT_EQ(graph.around(v).size(), v % 2 ? 0u : 2u);
}

} // namespace
} // namespace curvature_lines
