// Triangles that remember their polygons: which face each belongs to, and which sides lie inside.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {
namespace {

PolygonMesh planar(
	const std::vector<std::pair<double, double>>& points,
	const std::vector<std::vector<Index>>&        faces)
{
	PolygonMesh mesh;
	mesh.vertices.setZero(3, points.size());
	mesh.normals.resize(3, points.size());
	mesh.normals.colwise() = Eigen::Vector3d::UnitZ();
	for (std::size_t i = 0; i < points.size(); ++i)
		mesh.vertices.col(i).head<2>() = Eigen::Vector2d(points[i].first, points[i].second);
	mesh.faces = NeighborLists::fromRows(faces);
	return mesh;
}

Index innerSides(const PolygonTriangulation& result)
{
	return static_cast<Index>(std::count(result.inner.begin(), result.inner.end(), char(1)));
}

TEST(PolygonTriangulation, OfATriangleIsItself)
{
	const auto result = triangulatePolygons(planar({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}));
	ASSERT_EQ(result.triangles.faceCount(), 1);
	EXPECT_EQ(result.polygon, std::vector<Index>{0});
	EXPECT_EQ(result.inner, (std::vector<char>{0, 0, 0}));
	EXPECT_EQ(result.polygons.faceCount(), 1);
}

// A square beside a triangle: two triangles of face 0, whose common side is inner on both.
TEST(PolygonTriangulation, TrianglesKnowTheirFaces)
{
	const PolygonMesh mesh =
		planar({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0.5}}, {{0, 1, 2, 3}, {1, 4, 2}});
	const auto result = triangulatePolygons(mesh);
	ASSERT_EQ(result.triangles.faceCount(), 3);
	EXPECT_EQ(std::count(result.polygon.begin(), result.polygon.end(), 0), 2);
	EXPECT_EQ(std::count(result.polygon.begin(), result.polygon.end(), 1), 1);
	EXPECT_EQ(innerSides(result), 2);
	for (Index t = 0; t < 3; ++t)
		for (int c = 0; c < 3; ++c)
			EXPECT_TRUE(!result.inner[3 * t + c] || result.polygon[t] == 0);
	EXPECT_EQ(result.polygons.faces.indices, mesh.faces.indices);
}

// A polygon of twelve corners: a triangle in the middle has no side of the polygon, and belongs to it all the same.
TEST(PolygonTriangulation, TrianglesOfDiagonalsOnlyBelongToTheFaceAround)
{
	std::vector<std::pair<double, double>> corners;
	for (int k = 0; k < 12; ++k)
		corners.emplace_back(std::cos(k * EIGEN_PI / 6), std::sin(k * EIGEN_PI / 6));
	const auto result =
		triangulatePolygons(planar(corners, {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}));
	ASSERT_EQ(result.triangles.faceCount(), 10);
	EXPECT_EQ(result.polygon, std::vector<Index>(10, 0));
	EXPECT_EQ(innerSides(result), 3 * 10 - 12);
	EXPECT_EQ(result.polygons.faceCount(), 1);
}

// Two faces on the same four corners, as the sides of a pillow that is cut open: the diagonals of one must not be those
// of the other, so one at least becomes a star, whose triangles are faces.
TEST(PolygonTriangulation, StarsBecomeFaces)
{
	const PolygonMesh pillow =
		planar({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2, 3}, {3, 2, 1, 0}});
	const auto  result = triangulatePolygons(pillow);
	const Index hubs   = result.triangles.vertexCount() - pillow.vertexCount();
	EXPECT_EQ(result.triangles.faceCount(), 4 + 2 * hubs);
	EXPECT_EQ(result.polygons.faceCount(), 2 + 3 * hubs);
	EXPECT_EQ(innerSides(result), 2 * (2 - hubs));
	const MeshTopology topology = topologyOf(result.triangles);
	EXPECT_EQ(topology.nonmanifoldEdges, 0);
	EXPECT_EQ(topologyOf(result.polygons).eulerCharacteristic, topology.eulerCharacteristic);
}

} // namespace
} // namespace curvature_lines
