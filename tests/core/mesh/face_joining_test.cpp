// Which pairs of neighbouring faces become quads without their common edge, and which must not.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_joining.h"

#include <algorithm>
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

Index sideBetween(const LinkedFaces& faces, Index from, Index to)
{
	for (Index s = 0; s < faces.sideCount(); ++s)
		if (faces.from(s) == from && faces.to(s) == to)
			return s;
	return -1;
}

JoinedFaces
joinedAt(const PolygonMesh& mesh, Index a, Index b, const std::vector<VertexPair>& features = {})
{
	const LinkedFaces faces(mesh, std::vector<char>(mesh.vertexCount(), 0), features);
	return joinedFaces(faces, sideBetween(faces, a, b));
}

LinkedFaces::Loop sorted(LinkedFaces::Loop loop)
{
	std::sort(loop.begin(), loop.end());
	return loop;
}

TEST(FaceJoining, TwoTrianglesOfASquare)
{
	const PolygonMesh square =
		flatPolygons({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
	const JoinedFaces joined = joinedAt(square, 0, 2);
	ASSERT_EQ(joined.quads.size(), 1U);
	EXPECT_EQ(sorted(joined.quads[0]), (LinkedFaces::Loop{0, 1, 2, 3}));
	EXPECT_TRUE(joinedAt(square, 0, 1).quads.empty()) << "a rim";
	EXPECT_TRUE(joinedAt(square, 0, 2, {{0, 2}}).quads.empty()) << "a crease";
}

TEST(FaceJoining, NoConcaveQuad)
{
	const PolygonMesh arrow =
		flatPolygons({{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}});
	EXPECT_TRUE(joinedAt(arrow, 0, 2).quads.empty());
}

// A pentagon and a triangle, in three ways; only along the diagonal of the rectangle are both quads square.
TEST(FaceJoining, APentagonAndATriangleBecomeTwoQuads)
{
	const PolygonMesh rectangle = flatPolygons(
		{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}},
		{{0, 1, 3, 4, 5}, {1, 2, 3}});
	const JoinedFaces joined = joinedAt(rectangle, 1, 3);
	ASSERT_EQ(joined.quads.size(), 2U);
	std::vector<LinkedFaces::Loop> quads = {sorted(joined.quads[0]), sorted(joined.quads[1])};
	std::sort(quads.begin(), quads.end());
	EXPECT_EQ(quads[0], (LinkedFaces::Loop{0, 1, 4, 5}));
	EXPECT_EQ(quads[1], (LinkedFaces::Loop{1, 2, 3, 4}));
}

TEST(FaceJoining, EveryInnerVertexKeepsThreeEdges)
{
	// vertex 4 has three
	const PolygonMesh fan = flatPolygons(
		{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1.2, 0}},
		{{0, 1, 4}, {1, 2, 4}, {2, 3, 0, 4}});
	EXPECT_TRUE(joinedAt(fan, 1, 4).quads.empty());
}

} // namespace
} // namespace curvature_lines::test
