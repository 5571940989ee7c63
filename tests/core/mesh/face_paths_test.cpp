// Shortest ways between odd faces: along strips of squares to the other end or to the rim, dearer around a corner, not across
// what is no surface, and no further than allowed.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_paths.h"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// A triangle, unit squares in a row, and a triangle.
PolygonMesh strip(Index squares)
{
	std::vector<Vector3d>   vertices = {{0, .5, 0}};
	std::vector<VertexLoop> loops    = {{0, 1, 2}};
	for (Index k = 0; k <= squares; ++k) {
		vertices.emplace_back(1.0 + k, 0.0, 0.0);
		vertices.emplace_back(1.0 + k, 1.0, 0.0);
		const Index low = 2 * k + 1;
		if (k < squares)
			loops.push_back({low, low + 2, low + 3, low + 1});
	}
	vertices.emplace_back(2.0 + squares, 0.5, 0.0);
	const Index last = 2 * squares + 1;
	loops.push_back({last, last + 2, last + 1});
	return flatPolygons(vertices, loops);
}

struct Faces : LinkedFaces {
	explicit Faces(const PolygonMesh& mesh) :
			LinkedFaces(mesh, std::vector<char>(mesh.vertexCount(), 0), {})
	{
	}
};

TEST(FacePaths, OddFacesAndPairsOfTriangles)
{
	const Faces two(strip(2)), none(strip(0));
	EXPECT_TRUE(isOddFace(two, 0));
	EXPECT_FALSE(isOddFace(two, 1));
	for (Index s = 0; s < two.sideCount(); ++s)
		EXPECT_FALSE(joinsTriangles(two, s));
	Index joined = 0;
	for (Index s = 0; s < none.sideCount(); ++s)
		joined += joinsTriangles(none, s);
	EXPECT_EQ(joined, 2); // both sides of their edge
}

TEST(FacePaths, StraightThroughTheSquaresToTheOtherEnd)
{
	const Faces    faces(strip(3));
	FacePathSearch search(faces);
	for (const bool back : {false, true}) { // the search serves again
		const FacePath path = search.nearest(back ? 4 : 0, 100.0);
		ASSERT_EQ(path.sides.size(), 4U);
		for (Index k = 0; k < 4; ++k)
			EXPECT_EQ(faces.faceOf(path.sides[k]), back ? 4 - k : k);
		EXPECT_EQ(faces.faceOf(faces.across(path.sides.back())), back ? 0 : 4);
		EXPECT_NEAR(path.cost, 4.0, 0.5); // edges
		EXPECT_FALSE(path.endless);
	}
}

TEST(FacePaths, ToTheRimIfTheOtherEndIsFar)
{
	const Faces    faces(strip(12));
	FacePathSearch search(faces);
	const FacePath path = search.nearest(0, 100.0);
	ASSERT_FALSE(path.sides.empty());
	EXPECT_EQ(faces.across(path.sides.back()), LinkedFaces::rim);
	EXPECT_LT(path.cost, 12.0);
}

TEST(FacePaths, NoFurtherThanReach)
{
	const Faces    faces(strip(3));
	FacePathSearch search(faces);
	const FacePath none = search.nearest(0, 1.5);
	EXPECT_TRUE(none.sides.empty());
	EXPECT_TRUE(none.endless);
	EXPECT_FALSE(search.nearest(0, 4.5).sides.empty());
}

// A square between the two triangles, the second one at its other end or above it; in the second case there is one more
// square, so that the vertex opposite the corner of the path has the right number of edges.
TEST(FacePaths, CornersAreDearer)
{
	const PolygonMesh turn = flatPolygons(
		{{0, .5, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1.5, 2, 0}, {3, 0, 0}, {3, 1, 0}},
		{{0, 1, 4}, {1, 2, 3, 4}, {4, 3, 5}, {2, 6, 7, 3}});
	const Faces    straight(strip(1)), around(turn);
	const FacePath ahead  = FacePathSearch(straight).nearest(0, 100.0),
				   turned = FacePathSearch(around).nearest(0, 100.0);
	EXPECT_EQ(ahead.sides.size(), 2U);
	EXPECT_EQ(turned.sides.size(), 2U);
	EXPECT_GT(turned.cost, ahead.cost + 0.5);
}

// An edge of three faces is not crossed: there is the rim only.
TEST(FacePaths, NotAcrossEdgesOfThreeFaces)
{
	const Faces    faces(flatPolygons(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
        {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
	const FacePath path = FacePathSearch(faces).nearest(0, 100.0);
	ASSERT_EQ(path.sides.size(), 1U);
	EXPECT_EQ(faces.across(path.sides[0]), LinkedFaces::rim);
}

} // namespace
} // namespace curvature_lines::test
