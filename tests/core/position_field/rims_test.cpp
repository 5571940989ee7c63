// Rims of known surfaces: how many, where they turn, and which way they run.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "rims.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

TEST(Rims, OfASquareTurnAtItsCorners)
{
	const auto mesh = test::triangulatedPlane(16).mesh;
	const auto rims = findRims(mesh);
	ASSERT_EQ(rims.size(), 1u);
	const Rim& rim = rims[0];
	EXPECT_EQ(rim.size(), 4 * 16);
	int corners = 0;
	for (Index k = 0; k < rim.size(); ++k) {
		const Vector3d p        = mesh.vertices.col(rim.at(k));
		const bool     isCorner = std::abs(std::abs(p.x()) - std::abs(p.y())) < 1e-9;
		EXPECT_EQ(rim.isCorner(k), isCorner);
		corners += isCorner;
		if (isCorner)
			continue;
		// Along the side, with the square on the left.
		const Vector3d t = rim.tangent(k, mesh.vertices);
		EXPECT_NEAR(t.cwiseAbs().maxCoeff(), 1.0, 1e-9);
		EXPECT_GT(Vector3d::UnitZ().cross(t).dot(-p), 0.0);
	}
	EXPECT_EQ(corners, 4);
}

TEST(Rims, OfACylinderAreTwoCirclesWithoutCorners)
{
	const auto surface = test::triangulatedCylinder(48, 10);
	const auto rims    = findRims(surface.mesh);
	ASSERT_EQ(rims.size(), 2u);
	for (const Rim& rim : rims) {
		EXPECT_EQ(rim.size(), 48);
		for (Index k = 0; k < rim.size(); ++k) {
			EXPECT_FALSE(rim.isCorner(k));
			const Vector3d p = surface.mesh.vertices.col(rim.at(k)),
						   t = rim.tangent(k, surface.mesh.vertices);
			EXPECT_NEAR(t.z(), 0.0, 1e-9);
			EXPECT_NEAR(t.dot(p.normalized()), 0.0, 0.5 * 1e-9 + 1e-6);
			const Vector3d n = surface.truth.normals.col(rim.at(k));
			EXPECT_GT(n.cross(t).dot(Vector3d(0, 0, -p.z())), 0.0); // the surface on the left
		}
	}
}

TEST(Rims, IndicesGoRound)
{
	const auto rim = findRims(test::triangulatedPlane(16).mesh)[0];
	for (Index k = 0; k < rim.size(); ++k) {
		EXPECT_EQ(rim.at(k), rim.at(k + rim.size()));
		EXPECT_EQ(rim.at(k), rim.at(k - rim.size()));
		EXPECT_EQ(rim.isCorner(k), rim.isCorner(k - rim.size()));
	}
}

TEST(Rims, ClosedSurfacesHaveNoneAndShortOnesNoCorners)
{
	EXPECT_TRUE(findRims(test::triangulatedTorus(20, 10).mesh).empty());
	EXPECT_TRUE(findRims(TriangleMesh()).empty());
	const auto small = findRims(test::triangulatedPlane(4).mesh); // too short to tell
	ASSERT_EQ(small.size(), 1u);
	EXPECT_EQ(std::count(small[0].corner.begin(), small[0].corner.end(), 1), 0);
}

} // namespace
} // namespace curvature_lines
