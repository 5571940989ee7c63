// Patterns cover the face they cut, turn the same way round, and corners cost what their sines say.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_patterns.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// A regular polygon in the plane z = 0, then the middles of the sides named, then its centre.
std::vector<Vector3d> pointsOf(int corners, const std::vector<int>& divided)
{
	std::vector<Vector3d> points;
	for (int k = 0; k < corners; ++k) {
		const double angle = 2.0 * EIGEN_PI * k / corners;
		points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
	}
	for (const int k : divided)
		points.emplace_back(0.5 * (points[k] + points[(k + 1) % corners]));
	points.emplace_back(Vector3d::Zero());
	return points;
}

double areaOf(const std::vector<Vector3d>& points, const std::vector<Index>& loop)
{
	double twice = 0.0;
	for (std::size_t k = 0; k < loop.size(); ++k)
		twice += points[loop[k]].cross(points[loop[(k + 1) % loop.size()]]).z();
	return 0.5 * twice;
}

void expectCovers(const QuadPattern& pattern, const std::vector<Vector3d>& points, int corners)
{
	LinkedFaces::Loop all;
	for (Index v = 0; v < static_cast<Index>(points.size()); ++v)
		all.push_back(v);
	std::vector<LinkedFaces::Loop> parts;
	addParts(pattern, all, parts);
	ASSERT_EQ(parts.size(), static_cast<std::size_t>(pattern.count));
	double sum = 0.0;
	for (const LinkedFaces::Loop& part : parts)
		sum += areaOf(points, part);
	EXPECT_NEAR(sum, areaOf(points, {all.begin(), all.begin() + corners}), 1e-12);
	EXPECT_GE(leastSine(pattern, points, Vector3d::UnitZ()), -1e-12);
}

TEST(QuadPatterns, CoverTheFaceTheyCut)
{
	expectCovers(triangleEnd, pointsOf(3, {0}), 3);
	expectCovers(pentagonEnd, pointsOf(5, {0}), 5);
	for (int sides = 1; sides <= 3; ++sides)
		expectCovers(quadPassages[sides - 1], pointsOf(4, {0, sides}), 4);
	std::vector<Vector3d> points = pointsOf(4, {});
	points.pop_back();
	for (int k = 0; k < 4; ++k)
		points.emplace_back(0.5 * points[k]);
	expectCovers(quadRing, points, 4);
}

TEST(QuadPatterns, SinesOfCorners)
{
	const Vector3d up = Vector3d::UnitZ();
	EXPECT_DOUBLE_EQ(leastSine({Vector3d(0, 0, 0), {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, up), 1.0);
	EXPECT_NEAR(
		leastSine({Vector3d(0, 0, 0), {1, 0, 0}, {2, 1, 0}, {1, 1, 0}}, up), std::sqrt(0.5), 1e-12);
	EXPECT_LT(leastSine({Vector3d(0, 0, 0), {1, 0, 0}, {0.1, 0.1, 0}, {0, 1, 0}}, up), 0.0);
}

TEST(QuadPatterns, OnlyConcaveCornersCostMoreThanTheirAngle)
{
	EXPECT_EQ(cornerCost(1.0), 0.0);
	EXPECT_EQ(concaveCost(0.5), 0.0);
	EXPECT_GT(cornerCost(0.5), 0.0);
	EXPECT_GT(concaveCost(-0.5), 0.0);
	EXPECT_GT(cornerCost(-0.5), cornerCost(0.0) + concaveCost(-0.5));
	// whole numbers of steps, so that sums are exact in every order
	const double third = inSteps(1.0 / 3.0), fifth = inSteps(0.2), seventh = inSteps(1.0 / 7.0);
	EXPECT_EQ((third + fifth) + seventh, third + (fifth + seventh));
}

TEST(QuadPatterns, VerticesCostWhatTheyGetAwayFromFourEdges)
{
	std::vector<Vector3d>   vertices;
	std::vector<VertexLoop> loops;
	for (Index k = 0; k < 9; ++k)
		vertices.emplace_back(k % 3, k / 3, 0.0);
	for (const Index a : {0, 1, 3, 4})
		loops.push_back({a, a + 1, a + 4, a + 3});
	const PolygonMesh floor = flatPolygons(vertices, loops);
	const LinkedFaces faces(floor, std::vector<char>(9, 0), {});
	EXPECT_EQ(irregularityCost(faces, 4, 0), 0.0); // in the middle
	EXPECT_EQ(irregularityCost(faces, 4, 1), valenceCost);
	EXPECT_EQ(irregularityCost(faces, 4, -2), 2.0 * valenceCost);
	EXPECT_EQ(irregularityCost(faces, 1, -1), valenceCost); // on a side: three
	EXPECT_EQ(irregularityCost(faces, 0, 1), -valenceCost); // at a corner: two
}

} // namespace
} // namespace curvature_lines::test
