// Crease points of exact faces: on the edge, with its faces and angle; none on smooth surfaces and single sheets.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "crease_points.h"
#include "local_surface.h"
#include "neighborhoods.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

std::vector<SurfaceElement> elementsOf(const samples::SampleCloud& sample)
{
	std::vector<SurfaceElement> elements(sample.positions.cols());
	for (std::size_t i = 0; i < elements.size(); ++i) {
		const Vector3d d1 = sample.d1.col(i), d2 = sample.d2.col(i);
		elements[i].position = sample.positions.col(i);
		elements[i].normal   = sample.normals.col(i);
		elements[i].shape = sample.k1[i] * d1 * d1.transpose() + sample.k2[i] * d2 * d2.transpose();
		elements[i].valid = true;
	}
	return elements;
}

CreasePoints pointsOf(const std::string& surface, int count, double minAngle = 0.3)
{
	samples::SampleRequest request;
	request.surface             = surface;
	request.points              = count;
	request.seed                = 2;
	const auto           sample = samples::generate(request);
	const NeighborSearch search(sample.positions);
	return findCreasePoints(elementsOf(sample), search, minAngle);
}

void expectSound(const CreasePoint& p)
{
	EXPECT_NEAR(p.tangent.norm(), 1.0, 1e-9);
	EXPECT_NEAR(p.left.norm(), 1.0, 1e-9);
	EXPECT_NEAR(p.right.norm(), 1.0, 1e-9);
	EXPECT_GT(p.tangent.dot(p.left.cross(p.right)) * p.angle, 0.0);
	EXPECT_GE(p.weight, 0.0);
	EXPECT_LE(p.weight, 1.0);
	EXPECT_GT(p.spacing, 0.0);
}

TEST(CreasePoints, OfACubeLieOnItsEdges)
{
	const CreasePoints found = pointsOf("cube", 5000);
	EXPECT_GT(found.points.size(), 1000u);
	EXPECT_LT(found.faceDeviation, 1e-6);
	for (const CreasePoint& p : found.points) {
		expectSound(p);
		Vector3d sorted = p.position.cwiseAbs();
		std::sort(sorted.data(), sorted.data() + 3);
		EXPECT_NEAR(sorted[1], 0.5, 1e-6);
		EXPECT_NEAR(sorted[2], 0.5, 1e-6);
		EXPECT_NEAR(p.angle, EIGEN_PI / 2.0, 1e-6);
		EXPECT_NEAR(p.tangent.cwiseAbs().maxCoeff(), 1.0, 1e-6);
	}
}

TEST(CreasePoints, OfARoundEdgeLieOnTheCircle)
{
	const CreasePoints found = pointsOf("capped_cylinder", 5000);
	EXPECT_GT(found.points.size(), 500u);
	double worst = 0.0;
	for (const CreasePoint& p : found.points) {
		expectSound(p);
		worst = std::max(
			worst, std::hypot(p.position.head<2>().norm() - 0.5, std::abs(p.position.z()) - 0.5));
		EXPECT_NEAR(p.angle, EIGEN_PI / 2.0, 0.05);
	}
	EXPECT_LT(worst, 0.02);
}

TEST(CreasePoints, ConcaveEdgesHaveNegativeAngles)
{
	const CreasePoints found   = pointsOf("l_block", 6000);
	int                concave = 0;
	for (const CreasePoint& p : found.points) {
		expectSound(p);
		// the block's concave edge is the line x = y = 0
		const bool inside = p.position.head<2>().norm() < 0.02 && std::abs(p.position.z()) < 0.2;
		concave += p.angle < 0.0;
		if (inside) {
			EXPECT_LT(p.angle, 0.0);
		}
	}
	EXPECT_GT(concave, 50);
	EXPECT_LT(concave, static_cast<int>(found.points.size()) / 8);
}

TEST(CreasePoints, SmoothSurfacesAndRimsHaveNone)
{
	for (const char* surface : {"torus", "sphere", "plane", "helicoid", "capsule"})
		EXPECT_EQ(pointsOf(surface, 3000).points.size(), 0u) << surface;
}

TEST(CreasePoints, AnglesBelowTheSmallestCountAsNone)
{
	EXPECT_EQ(pointsOf("cube", 3000, 1.7).points.size(), 0u);
}

} // namespace
} // namespace curvature_lines
