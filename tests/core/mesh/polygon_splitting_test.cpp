// Cutting polygons: area, Euler number, convexity and corner counts of known shapes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_splitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

PolygonMesh planar(
	const std::vector<std::pair<double, double>>& points,
	const std::vector<std::vector<Index>>&        faces)
{
	PolygonMesh mesh;
	mesh.vertices.resize(3, points.size());
	mesh.normals.resize(3, points.size());
	mesh.normals.colwise() = Vector3d::UnitZ();
	for (std::size_t i = 0; i < points.size(); ++i)
		mesh.vertices.col(i) = Vector3d(points[i].first, points[i].second, 0.0);
	mesh.faces = NeighborLists::fromRows(faces);
	return mesh;
}

// A ring of random radii: one polygon, star-shaped and concave.
PolygonMesh star(Index corners, unsigned seed)
{
	std::mt19937                           random(seed);
	std::uniform_real_distribution<double> radius(0.4, 1.0);
	std::vector<std::pair<double, double>> points;
	std::vector<Index>                     face;
	for (Index k = 0; k < corners; ++k) {
		const double a = 6.283185307179586 * k / corners, r = radius(random);
		points.emplace_back(r * std::cos(a), r * std::sin(a));
		face.push_back(k);
	}
	return planar(points, {face});
}

double signedArea(const PolygonMesh& mesh, Index f)
{
	double      area = 0.0;
	const auto& face = mesh.faces[f];
	for (Index k = 0; k < face.size(); ++k)
		area += 0.5 * Vector3d(mesh.vertices.col(face[k]))
		                  .cross(Vector3d(mesh.vertices.col(face[(k + 1) % face.size()])))
		                  .z();
	return area;
}

double totalArea(const PolygonMesh& mesh)
{
	double area = 0.0;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		EXPECT_GT(signedArea(mesh, f), 0.0);
		area += signedArea(mesh, f);
	}
	return area;
}

double largestCorner(const PolygonMesh& mesh, Index f)
{
	double      largest = 0.0;
	const auto& face    = mesh.faces[f];
	const Index n       = face.size();
	for (Index k = 0; k < n; ++k) {
		const Vector3d p   = mesh.vertices.col(face[k]);
		const Vector3d a   = mesh.vertices.col(face[(k + 1) % n]) - p,
					   b   = mesh.vertices.col(face[(k + n - 1) % n]) - p;
		const double angle = std::atan2(a.cross(b).z(), a.dot(b)) * 180.0 / 3.14159265358979323846;
		largest            = std::max(largest, angle < 0.0 ? angle + 360.0 : angle);
	}
	return largest;
}

void expectOneSheet(const PolygonMesh& mesh, double area)
{
	EXPECT_NEAR(totalArea(mesh), area, 1e-12);
	const MeshTopology topology = topologyOf(mesh);
	EXPECT_EQ(topology.eulerCharacteristic, 1);
	EXPECT_EQ(topology.boundaryLoops, 1);
	EXPECT_EQ(topology.nonmanifoldEdges + topology.nonmanifoldVertices, 0);
}

TEST(PolygonSplitter, TriangulationKeepsAreaAndCounts)
{
	for (unsigned seed = 1; seed <= 20; ++seed) {
		const Index       corners = 4 + static_cast<Index>(seed);
		const PolygonMesh whole   = star(corners, seed);
		PolygonSplitter   splitter(whole);
		splitter.triangulate();
		const PolygonMesh parts = splitter.mesh();
		expectOneSheet(parts, signedArea(whole, 0));
		EXPECT_EQ(topologyOf(parts).triangles, corners - 2);
		EXPECT_EQ(parts.vertexCount(), corners);
	}
}

TEST(PolygonSplitter, ConcavePolygonsBecomeConvexUnlessQuads)
{
	for (unsigned seed = 1; seed <= 20; ++seed) {
		const PolygonMesh whole = star(9, seed);
		PolygonSplitter   splitter(whole);
		splitter.splitConcaveFaces();
		const PolygonMesh parts = splitter.mesh();
		expectOneSheet(parts, signedArea(whole, 0));
		for (Index f = 0; f < parts.faceCount(); ++f) {
			const bool quad = parts.faces[f].size() == 4;
			EXPECT_LE(largestCorner(parts, f), quad ? 360.0 : 185.0);
		}
	}
}

// An L of three unit squares, with T-vertices: the cuts run on along the lines.
TEST(PolygonSplitter, LargeFacesAreCutAlongTheLines)
{
	const PolygonMesh whole = planar(
		{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}},
		{{0, 1, 2, 3, 4, 5, 6, 7}});
	PolygonSplitter splitter(whole);
	splitter.cutLargeFaces();
	const PolygonMesh parts = splitter.mesh();
	expectOneSheet(parts, 3.0);
	ASSERT_EQ(parts.faceCount(), 3);
	for (Index f = 0; f < 3; ++f) {
		EXPECT_EQ(parts.faces[f].size(), 4);
		EXPECT_NEAR(signedArea(parts, f), 1.0, 1e-12);
	}
}

TEST(PolygonSplitter, TriangleAndPentagonBecomeTwoQuads)
{
	const PolygonMesh whole =
		planar({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1.2}, {0, 1}}, {{0, 1, 3, 4, 5}, {1, 2, 3}});
	PolygonSplitter splitter(whole);
	splitter.pairWithPentagons();
	const PolygonMesh parts = splitter.mesh();
	EXPECT_EQ(topologyOf(parts).quads, 2);
	expectOneSheet(parts, signedArea(whole, 0) + signedArea(whole, 1));
}

TEST(PolygonSplitter, NoSecondEdgeBetweenTwoVertices)
{
	// Two triangles and a quad on the same two vertices 0 and 2: the quad's other diagonal is the
	// only one left.
	const PolygonMesh whole =
		planar({{0, 0}, {1, -0.2}, {2, 0}, {1, 1}, {1, -3}}, {{0, 1, 2, 3}, {0, 4, 2, 1}});
	PolygonSplitter splitter(whole);
	splitter.triangulate();
	const MeshTopology topology = topologyOf(splitter.mesh());
	EXPECT_EQ(topology.nonmanifoldEdges, 0);
	EXPECT_EQ(topology.triangles, 4);
	EXPECT_EQ(topology.eulerCharacteristic, 1);
}

TEST(PolygonSplitter, GoodFacesAreLeftAlone)
{
	// A pentagon with a T-vertex is as the lines made it.
	const PolygonMesh whole = planar({{0, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0, 1}}, {{0, 1, 2, 3, 4}});
	PolygonSplitter   splitter(whole);
	splitter.cutLargeFaces();
	splitter.pairWithPentagons();
	splitter.splitConcaveFaces();
	EXPECT_EQ(splitter.mesh().faces.indices, whole.faces.indices);
}

} // namespace
} // namespace curvature_lines
