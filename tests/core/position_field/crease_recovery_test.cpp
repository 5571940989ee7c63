// Creases that are put into triangulations: missing points, crossing edges, and what is there already.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "crease_recovery.h"
#include "point_cloud.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

// A square of 2 x 2 cells about a crease that no triangle has: one of its points is missing, the other two are
// joined across it.
TEST(CreaseRecovery, PutsMissingPointsInAndFlipsWhatCrosses)
{
	Eigen::Matrix3Xd points(3, 9);
	for (Index k = 0; k < 9; ++k)
		points.col(k) << k % 3, k / 3, k % 3 == 1 ? 0.3 : 0.0;
	// Crease 1, 4, 7; vertex 4 is unused: the triangles run from 3 to 5 and to the corners.
	std::vector<Triangle> triangles = {
		{0, 1, 3}, {1, 5, 3}, {1, 2, 5}, {3, 5, 7}, {3, 7, 6}, {5, 8, 7}};
	recoverCreaseEdges(points, {{1, 4}, {4, 7}}, triangles);
	std::vector<Index>          copies;
	const std::vector<Triangle> kept = manifoldPart(triangles, 9, copies);
	EXPECT_EQ(kept.size(), 8u);
	EXPECT_TRUE(copies.empty());
	const TriangleMesh mesh(points, kept);
	EXPECT_GE(mesh.edgeBetween(1, 4), 0);
	EXPECT_GE(mesh.edgeBetween(4, 7), 0);
	EXPECT_EQ(mesh.eulerCharacteristic(), 1);
	EXPECT_EQ(mesh.rims().size(), 1u);
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		EXPECT_GT(mesh.areaVector(t).z(), 0.0);
}

// Two edges cross the missing one.
TEST(CreaseRecovery, FlipsSeveralEdges)
{
	Eigen::Matrix3Xd points(3, 6);
	points << 0, 1, 1, 2, 2, 3, //
		0, -1, 1, -1, 1, 0,     //
		0, 0, 0, 0, 0, 0;
	std::vector<Triangle> triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
	recoverCreaseEdges(points, {{0, 5}}, triangles);
	const TriangleMesh mesh(points, triangles);
	EXPECT_GE(mesh.edgeBetween(0, 5), 0);
	EXPECT_EQ(mesh.eulerCharacteristic(), 1);
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		EXPECT_GT(mesh.areaVector(t).z(), 0.0);
}

// A crease across the diagonals of a grid whose points are all there.
TEST(CreaseRecovery, FlipsTheDiagonalsOfAGrid)
{
	const auto                           grid = test::triangulatedPlane(8).mesh;
	std::vector<std::pair<Index, Index>> wanted;
	// beside the diagonal of the square, where every cell is cut the other way
	for (Index k = 0; k < 7; ++k)
		wanted.emplace_back(10 * k + 1, 10 * k + 11);
	for (const auto& [a, b] : wanted)
		EXPECT_EQ(grid.edgeBetween(a, b), -1);
	std::vector<Triangle> triangles = grid.triangles();
	recoverCreaseEdges(grid.vertices, wanted, triangles);
	EXPECT_EQ(triangles.size(), grid.triangles().size());
	const TriangleMesh mesh(grid.vertices, triangles);
	for (const auto& [a, b] : wanted)
		EXPECT_GE(mesh.edgeBetween(a, b), 0);
	EXPECT_EQ(mesh.eulerCharacteristic(), 1);
	EXPECT_NEAR(mesh.vertexAreas().sum(), 1.0, 1e-12);
}

TEST(CreaseRecovery, EdgesThatAreThereStay)
{
	const auto            grid      = test::triangulatedPlane(6).mesh;
	std::vector<Triangle> triangles = grid.triangles();
	recoverCreaseEdges(grid.vertices, {{0, 1}, {1, 2}, {2, 9}}, triangles);
	EXPECT_EQ(triangles, grid.triangles());
}

} // namespace
} // namespace curvature_lines
