// Polygons over growing arrays of vertices: disks with plain borders and with borders that touch themselves.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygons.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

Polygons pointsOnACircle(int count)
{
	Eigen::Matrix3Xd positions(3, count), normals(3, count);
	for (int k = 0; k < count; ++k) {
		const double a = 2.0 * EIGEN_PI * k / count;
		positions.col(k) << std::cos(a), std::sin(a), 0.0;
		normals.col(k) = Vector3d::UnitZ();
	}
	return Polygons(HalfEdgeGraph(positions, normals, {}), {});
}

TEST(Polygons, TakesTheFacesOfAGraph)
{
	// A triangle: the loop inside becomes a face of its vertices, in their order.
	Eigen::Matrix3Xd positions(3, 3);
	positions << 0, 1, 0, 0, 0, 1, 0, 0, 0;
	std::vector<HalfEdgeGraph::Edge> edges(3);
	for (Index k = 0; k < 3; ++k) {
		const Index    to     = (k + 1) % 3;
		const Vector3d along  = (positions.col(to) - positions.col(k)).normalized();
		edges[k].from         = k;
		edges[k].to           = to;
		edges[k].tangentFrom  = along;
		edges[k].tangentTo    = -along;
		edges[k].middle       = 0.5 * (positions.col(to) + positions.col(k));
		edges[k].middleNormal = Vector3d::UnitZ();
	}
	const HalfEdgeGraph graph(positions, Vector3d::UnitZ().replicate(1, 3), edges);
	const PolygonMesh   mesh = Polygons(graph, {{0, 2, 4}}).mesh();
	ASSERT_EQ(mesh.faceCount(), 1);
	EXPECT_EQ(
		std::vector<Index>(mesh.faces[0].begin(), mesh.faces[0].end()),
		(std::vector<Index>{0, 1, 2}));
	EXPECT_EQ(mesh.vertices, positions);
}

TEST(Polygons, APlainBorderIsOneFace)
{
	Polygons polygons = pointsOnACircle(6);
	polygons.addDisk({0, 1, 2, 3, 4, 5});
	EXPECT_EQ(polygons.vertices.size(), 6u);
	ASSERT_EQ(polygons.faces.size(), 1u);
	EXPECT_EQ(polygons.faces[0], (std::vector<Index>{0, 1, 2, 3, 4, 5}));
}

TEST(Polygons, ABorderThatTouchesItselfGetsARingOfQuads)
{
	Polygons                 polygons = pointsOnACircle(6);
	const std::vector<Index> border   = {0, 1, 2, 0, 3, 4}; // vertex 0 twice
	polygons.addDisk(border);
	EXPECT_EQ(polygons.vertices.size(), 12u);
	ASSERT_EQ(polygons.faces.size(), 7u);
	std::size_t quads = 0;
	for (const auto& face : polygons.faces) {
		std::vector<Index> sorted = face;
		std::sort(sorted.begin(), sorted.end());
		EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
		quads += face.size() == 4;
	}
	EXPECT_EQ(quads, 6u);
	// V grows by 6, E by 12, F by 6 for what was one face: the Euler characteristic of the disk stays.
	for (std::size_t k = 0; k < border.size(); ++k) {
		EXPECT_EQ(polygons.faces[k][0], border[k]);
		EXPECT_EQ(polygons.faces[k][1], border[(k + 1) % 6]);
	}
	// The ring lies inside.
	for (std::size_t v = 6; v < 12; ++v)
		EXPECT_LT(polygons.vertices[v].norm(), 1.0);
}

TEST(Polygons, TheMeshHasTheUsedVerticesOnly)
{
	Polygons polygons = pointsOnACircle(6);
	polygons.addDisk({1, 3, 5});
	std::vector<Index> names;
	const PolygonMesh  mesh = polygons.mesh(&names);
	EXPECT_EQ(mesh.vertexCount(), 3);
	EXPECT_EQ(names, (std::vector<Index>{-1, 0, -1, 1, -1, 2}));
	for (const Index v : {1, 3, 5})
		EXPECT_EQ(mesh.vertices.col(names[v]), polygons.vertices[v]);
	ASSERT_EQ(mesh.faceCount(), 1);
	EXPECT_EQ(
		std::vector<Index>(mesh.faces[0].begin(), mesh.faces[0].end()),
		(std::vector<Index>{0, 1, 2}));
	EXPECT_EQ(pointsOnACircle(4).mesh().vertexCount(), 0);
}

} // namespace
} // namespace curvature_lines
