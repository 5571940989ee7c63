// Triangles at the rim of a strip: those with a short side vanish, and only where nothing is at stake.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "rim_cleanup.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// Two rows of quads; between the upper row's quads k and k + 1 a triangle with its side, of this length, on the rim:
//
//   a--a--t-t--a--a
//   |  |  \ /  |  |
//   b--b---b---b--b
//   |  |   |   |  |
//   c--c---c---c--c
PolygonMesh stripWithTriangle(double side)
{
	std::vector<Vector3d> points;
	for (int row = 0; row < 2; ++row)
		for (int k = -2; k <= 2; ++k)
			points.emplace_back(k, row, 0.0); // 0 .. 4: c, 5 .. 9: b
	for (const double x : {-2.0, -1.0, -0.5 * side, 0.5 * side, 1.0, 2.0})
		points.emplace_back(x, 2.0, 0.0); // 10 .. 15
	PolygonMesh mesh;
	mesh.vertices.resize(3, points.size());
	for (std::size_t v = 0; v < points.size(); ++v)
		mesh.vertices.col(v) = points[v];
	mesh.normals = Vector3d::UnitZ().replicate(1, points.size());
	mesh.faces   = NeighborLists::fromRows(
        {{0, 1, 6, 5},
	       {1, 2, 7, 6},
	       {2, 3, 8, 7},
	       {3, 4, 9, 8},
	       {5, 6, 11, 10},
	       {6, 7, 12, 11},
	       {7, 13, 12},
	       {7, 8, 14, 13},
	       {8, 9, 15, 14}});
	return mesh;
}

std::vector<char> rimOf(const PolygonMesh& mesh)
{
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		const Vector3d p = mesh.vertices.col(v);
		onFeature[v]     = std::abs(p.x()) == 2.0 || p.y() == 0.0 || p.y() == 2.0;
	}
	return onFeature;
}

TEST(RimCleanup, ATriangleWithAShortSideVanishes)
{
	const PolygonMesh  mesh      = stripWithTriangle(0.3);
	std::vector<char>  onFeature = rimOf(mesh);
	const PolygonMesh  merged    = mergeRimTriangles(mesh, onFeature, 0.5);
	const MeshTopology before = topologyOf(mesh), after = topologyOf(merged);
	EXPECT_EQ(before.triangles, 1);
	EXPECT_EQ(after.triangles, 0);
	EXPECT_EQ(after.quads, 8);
	EXPECT_EQ(after.faces, 8);
	EXPECT_EQ(after.vertices, before.vertices - 1);
	EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
	EXPECT_EQ(after.boundaryLoops, 1);
	ASSERT_EQ(static_cast<Index>(onFeature.size()), merged.vertexCount());
	EXPECT_EQ(onFeature, rimOf(merged));
	// The merged end lies in the middle.
	bool found = false;
	for (Index v = 0; v < merged.vertexCount(); ++v)
		found = found || (merged.vertices.col(v) - Vector3d(0, 2, 0)).norm() < 1e-12;
	EXPECT_TRUE(found);
}

TEST(RimCleanup, ALongSideStays)
{
	const PolygonMesh mesh      = stripWithTriangle(0.8);
	std::vector<char> onFeature = rimOf(mesh);
	EXPECT_EQ(topologyOf(mergeRimTriangles(mesh, onFeature, 0.5)).triangles, 1);
	EXPECT_EQ(onFeature, rimOf(mesh));
	EXPECT_EQ(topologyOf(mergeRimTriangles(mesh, onFeature, 0.9)).triangles, 0);
}

TEST(RimCleanup, TrianglesBetweenFeaturesAndCornersStay)
{
	const PolygonMesh mesh      = stripWithTriangle(0.3);
	std::vector<char> onFeature = rimOf(mesh);
	onFeature[7]                = 1; // the tip lies on a crease
	EXPECT_EQ(topologyOf(mergeRimTriangles(mesh, onFeature, 0.5)).triangles, 1);
	// The rim turns at one of the two ends.
	PolygonMesh bent          = mesh;
	bent.vertices.col(11).y() = bent.vertices.col(10).y() = 4.0;
	onFeature                                             = rimOf(mesh);
	EXPECT_EQ(topologyOf(mergeRimTriangles(bent, onFeature, 0.5)).triangles, 1);
}

TEST(RimCleanup, AMeshWithoutTrianglesIsTheSame)
{
	std::vector<char> none;
	EXPECT_EQ(mergeRimTriangles(PolygonMesh(), none, 0.5).faceCount(), 0);
	PolygonMesh quad;
	quad.vertices.resize(3, 4);
	quad.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
	quad.normals = Vector3d::UnitZ().replicate(1, 4);
	quad.faces   = NeighborLists::fromRows({{0, 1, 2, 3}});
	std::vector<char> all(4, 1);
	const PolygonMesh same = mergeRimTriangles(quad, all, 0.5);
	EXPECT_EQ(same.vertices, quad.vertices);
	EXPECT_EQ(same.faces.indices, quad.faces.indices);
}

} // namespace
} // namespace curvature_lines
