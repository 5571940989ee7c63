// What lies across each side, before and after faces are replaced.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "linked_faces.h"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// Three unit squares in a row; vertices 0 to 3 below, 4 to 7 above.
PolygonMesh row()
{
	std::vector<Vector3d> vertices;
	for (Index k = 0; k < 8; ++k)
		vertices.emplace_back(k % 4, k / 4, 0.0);
	return polygonMesh(
		vertices,
		std::vector<Vector3d>(8, Vector3d::UnitZ()),
		{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}});
}

// Every side's neighbour has the same two vertices and names it in turn; the counts of edges are right.
void expectLinked(const LinkedFaces& faces)
{
	const PolygonMesh  mesh     = faces.mesh();
	const auto         rims     = rimSides(mesh);
	const VertexLoop   expected = edgesAtVertices(mesh);
	std::vector<char>  onRim(mesh.vertexCount(), 0);
	std::vector<Index> shown;
	for (Index f = 0; f < faces.faceCount(); ++f)
		for (Index k = 0; k < faces.size(f); ++k) {
			const Index s = faces.firstSide(f) + k, there = faces.across(s);
			EXPECT_EQ(faces.faceOf(s), f);
			EXPECT_EQ(faces.next(faces.previous(s)), s);
			EXPECT_EQ(rims.count({faces.from(s), faces.to(s)}) == 1, there == LinkedFaces::rim);
			EXPECT_NEAR(
				faces.length(s),
				(faces.position(faces.from(s)) - faces.position(faces.to(s))).norm(),
				1e-15);
			if (there < 0) {
				onRim[faces.from(s)] = onRim[faces.to(s)] = 1;
				continue;
			}
			EXPECT_FALSE(faces.isReplaced(faces.faceOf(there)));
			EXPECT_EQ(faces.across(there), s);
			EXPECT_EQ(faces.from(there), faces.to(s));
			EXPECT_EQ(faces.to(there), faces.from(s));
			EXPECT_EQ(faces.isFeature(there), faces.isFeature(s));
		}
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		EXPECT_EQ(faces.valence(v), expected[v]);
		EXPECT_EQ(faces.isOnRim(v), onRim[v] != 0);
	}
}

TEST(LinkedFaces, FindTheirNeighbors)
{
	expectLinked({row(), std::vector<char>(8, 0), {}});
	const PolygonMesh polygons = randomPolygons(triangulatedCylinder(12, 8).mesh, 7, 0.6, 3);
	expectLinked({polygons, std::vector<char>(polygons.vertexCount(), 0), {}});
}

TEST(LinkedFaces, ReplacedByHalves)
{
	std::vector<char> marks(8, 0);
	marks[1] = marks[5] = marks[2] = marks[6] = 1;
	LinkedFaces faces(row(), marks, {{1, 5}});
	// the middle and the right square, cut along the middle from the crease to the rim
	const Index crease = faces.firstSide(1) + 3, inner = faces.firstSide(1) + 1,
				end = faces.firstSide(2) + 1;
	ASSERT_TRUE(faces.isFeature(crease));
	ASSERT_FALSE(faces.isFeature(inner));
	const Index a = faces.addMiddle(crease), b = faces.addMiddle(inner), c = faces.addMiddle(end);
	EXPECT_EQ(faces.position(b), Vector3d(2.0, 0.5, 0.0));
	faces.replace(
		{0, 1, 2},
		{{crease, a}, {faces.across(crease), a}, {inner, b}, {faces.across(inner), b}, {end, c}},
		{{0, 1, a, 5, 4}, {1, 2, b, a}, {a, b, 6, 5}, {2, 3, c, b}, {b, c, 7, 6}});
	expectLinked(faces);
	EXPECT_EQ(faces.faceCount(), 8);
	EXPECT_EQ(faces.mesh().faceCount(), 5);
	EXPECT_EQ(faces.valence(a), 3);
	EXPECT_EQ(faces.valence(b), 4);
	EXPECT_EQ(faces.featureEdges(), (std::vector<VertexPair>{{1, a}, {5, a}}));
	EXPECT_TRUE(faces.isOnFeature(a)) << "along the crease";
	EXPECT_FALSE(faces.isOnFeature(b)) << "between marked vertices, but no crease";
	EXPECT_FALSE(faces.isOnFeature(c)) << "on a rim whose ends are not marked";
}

TEST(LinkedFaces, EdgesThatAreNotManifoldAreTangled)
{
	const std::vector<Vector3d> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
	const std::vector<Vector3d> normals(5, Vector3d::UnitZ());
	const std::vector<char>     marks(5, 0);
	const LinkedFaces           three(
        polygonMesh(vertices, normals, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), marks, {});
	const LinkedFaces turned(polygonMesh(vertices, normals, {{0, 1, 2}, {0, 1, 3}}), marks, {});
	for (const LinkedFaces* faces : {&three, &turned})
		for (Index f = 0; f < faces->faceCount(); ++f) {
			EXPECT_EQ(faces->across(faces->firstSide(f)), LinkedFaces::tangled);
			EXPECT_EQ(faces->across(faces->firstSide(f) + 1), LinkedFaces::rim);
		}
}

TEST(LinkedFaces, EdgesBetweenMarkedVertices)
{
	const std::vector<char> marks = {1, 1, 0, 1, 1, 0, 0, 1};
	EXPECT_EQ(edgesBetween(row(), marks), (std::vector<VertexPair>{{0, 1}, {0, 4}, {3, 7}}));
}

} // namespace
} // namespace curvature_lines::test
