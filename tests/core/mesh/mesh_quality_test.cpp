// Folds, corners and gaps of meshes on which they are counted by hand.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Squares of the plane z = 0, normals up.
PolygonMesh floorOf(Index cells, double edge)
{
	std::vector<Vector3d>           vertices;
	std::vector<std::vector<Index>> faces;
	for (Index j = 0; j <= cells; ++j)
		for (Index i = 0; i <= cells; ++i)
			vertices.emplace_back(edge * i, edge * j, 0.0);
	for (Index j = 0; j < cells; ++j)
		for (Index i = 0; i < cells; ++i) {
			const Index a = j * (cells + 1) + i;
			faces.push_back({a, a + 1, a + cells + 2, a + cells + 1});
		}
	return polygonMesh(vertices, std::vector<Vector3d>(vertices.size(), Vector3d::UnitZ()), faces);
}

PolygonMesh oneFace(const std::vector<Vector3d>& corners)
{
	std::vector<Index> loop;
	for (std::size_t k = 0; k < corners.size(); ++k)
		loop.push_back(static_cast<Index>(k));
	return polygonMesh(corners, std::vector<Vector3d>(corners.size(), Vector3d::UnitZ()), {loop});
}

TEST(MeshQuality, FacesAgainstTheirNormalsAreFolded)
{
	PolygonMesh mesh = floorOf(6, 0.1);
	EXPECT_EQ(foldedFaces(mesh), 0);
	auto loops = faceLoopsOf(mesh);
	for (const Index f : {3, 17, 20})
		std::reverse(loops[f].begin(), loops[f].end());
	mesh.faces = NeighborLists::fromRows(loops);
	EXPECT_EQ(foldedFaces(mesh), 3);
	mesh.normals *= -1.0;
	EXPECT_EQ(foldedFaces(mesh), 33);
	// A vertex pulled over the next column turns two faces; far away from it nothing happens.
	mesh = floorOf(6, 0.1);
	mesh.vertices.col(3 * 7 + 3).x() += 0.25;
	EXPECT_EQ(foldedFaces(mesh), 2);
	const RigidMotion motion;
	mesh.vertices = motion.ofPoints(mesh.vertices);
	mesh.normals  = motion.ofVectors(mesh.normals);
	EXPECT_EQ(foldedFaces(mesh), 2);
	EXPECT_EQ(foldedFaces(PolygonMesh()), 0);
}

TEST(MeshQuality, TheScaledJacobianIsTheSineOfTheWorstCorner)
{
	EXPECT_NEAR(scaledJacobian(floorOf(1, 3.0), 0), 1.0, 1e-12);
	for (const double angle : {0.2, 0.7, 1.3}) {
		const Vector3d side(std::cos(angle), std::sin(angle), 0.0), along(2.0, 0.0, 0.0);
		EXPECT_NEAR(
			scaledJacobian(oneFace({Vector3d::Zero(), along, along + side, side}), 0),
			std::sin(angle),
			1e-12);
		// Turned over.
		EXPECT_NEAR(
			scaledJacobian(oneFace({Vector3d::Zero(), side, along + side, along}), 0),
			-std::sin(angle),
			1e-12);
	}
	// A dart: its concave corner has 270 degrees.
	EXPECT_NEAR(
		scaledJacobian(oneFace({{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}}), 0), -1.0, 1e-12);
	// Two corners in one place: no angle, and no NaN.
	EXPECT_NEAR(
		scaledJacobian(oneFace({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}), 0), 0.0, 1e-12);
}

TEST(MeshQuality, CountsPointsFartherThanTwoEdges)
{
	const PolygonMesh mesh = floorOf(4, 0.25);
	Matrix3Xd         points(3, 5);
	points << 0.5, 0.3, 0.1, 1.3, 1.6, //
		0.5, 0.7, 0.2, 0.5, 0.5,       //
		0.0, 0.49, 0.51, 0.0, 0.0;
	MeshCoverage coverage = coverageOf(mesh, points);
	EXPECT_EQ(coverage.uncovered, 2); // above by more than half, and outside by .6
	EXPECT_NEAR(coverage.largestGap, 0.6, 1e-12);
	coverage = coverageOf(mesh, points.leftCols(2));
	EXPECT_EQ(coverage.uncovered, 0);
	EXPECT_NEAR(coverage.largestGap, 0.49, 1e-12);
	coverage = coverageOf(mesh, Matrix3Xd(3, 0));
	EXPECT_EQ(coverage.uncovered, 0);
	EXPECT_EQ(coverage.largestGap, 0.0);
	coverage = coverageOf(PolygonMesh(), points);
	EXPECT_EQ(coverage.uncovered, 5);
	EXPECT_EQ(coverage.largestGap, INFINITY);
}

} // namespace
} // namespace curvature_lines::test
