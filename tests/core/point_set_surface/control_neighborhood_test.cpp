// Sums over control points against brute force, sheets that are kept apart, and places without a surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "control_neighborhood.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

PointCloud planeCloud(int points)
{
	samples::SampleRequest request;
	request.surface   = "plane";
	request.points    = points;
	request.noise     = 0.002;
	request.seed      = 6;
	const auto sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

TEST(ControlNeighborhood, SumsAreThoseOfAllItsPoints)
{
	const PointCloud          cloud = planeCloud(1500);
	const std::vector<double> spacing(cloud.size(), 1.0 / std::sqrt(1500.0));
	const ControlPoints       control(cloud, spacing);
	ControlNeighborhood       around;
	const Vector3d            place(0.1, -0.05, 0.004);
	ASSERT_TRUE(around.gather(control, place, 4.0));
	EXPECT_NEAR(around.spacing(), spacing[0], 1e-9);
	EXPECT_GT(around.side().z(), 0.99);
	const double h = 1.5 * spacing[0];
	NormalSums   expected;
	PlaneSums    plane;
	for (int k = 0; k < around.size(); ++k) {
		const Vector3d d = around.position(k) - place, n = around.normal(k);
		EXPECT_LE(d.norm(), 4.0 * spacing[0] * 1.01);
		const double w = std::exp(-d.squaredNorm() / (h * h));
		expected.weight += w;
		expected.offset += w * d;
		expected.normal += w * n;
		expected.plane += w * d.dot(n);
		plane.square += w * d * d.transpose();
	}
	const NormalSums normals = around.normalSums(place, h);
	EXPECT_NEAR(normals.weight, expected.weight, 1e-4 * expected.weight);
	EXPECT_LT((normals.offset - expected.offset).norm(), 1e-4 * h * expected.weight);
	EXPECT_LT((normals.normal - expected.normal).norm(), 1e-4 * expected.weight);
	EXPECT_NEAR(normals.plane, expected.plane, 1e-4 * h * expected.weight);
	const PlaneSums planes = around.planeSums(place, h);
	EXPECT_NEAR(planes.weight, expected.weight, 1e-4 * expected.weight);
	EXPECT_LT((planes.square - plane.square).norm(), 1e-4 * h * h * expected.weight);
}

// All points within reach take part, or the closest of them where they are many.
TEST(ControlNeighborhood, HoldsTheClosestPointsWithinReach)
{
	const PointCloud          cloud = planeCloud(1500);
	const std::vector<double> spacing(cloud.size(), 1.0 / std::sqrt(1500.0));
	const ControlPoints       control(cloud, spacing);
	ControlNeighborhood       around;
	for (const double reach : {2.0, 4.0})
		for (const Vector3d& place :
		     {Vector3d(0, 0, 0), Vector3d(0.2, 0.3, 0.01), Vector3d(-0.4, 0, 0)}) {
			ASSERT_TRUE(around.gather(control, place, reach));
			const auto inside =
				control.search.within(place, reach * around.spacing()); // by distance
			ASSERT_LE(around.size(), static_cast<int>(inside.size()));
			EXPECT_GE(around.size(), std::min<int>(inside.size(), int(EIGEN_PI * reach * reach)));
			double farthest = 0.0;
			for (int k = 0; k < around.size(); ++k)
				farthest = std::max(farthest, (around.position(k) - place).norm());
			const Index last = inside[around.size() - 1];
			EXPECT_NEAR(farthest, (cloud.positions.col(last) - place).norm(), 1e-12);
		}
}

TEST(ControlNeighborhood, KeepsOpposingSheetsApart)
{
	const PointCloud front = planeCloud(1500);
	PointCloud       both;
	both.positions.resize(3, 3000);
	both.normals.resize(3, 3000);
	both.positions << front.positions, front.positions.colwise() - Vector3d(0, 0, 0.02);
	both.normals << front.normals, -front.normals;
	const std::vector<double> spacing(3000, 1.0 / std::sqrt(1500.0));
	const ControlPoints       control(both, spacing);
	ControlNeighborhood       around;
	for (const double z : {0.004, -0.024}) {
		ASSERT_TRUE(around.gather(control, Vector3d(0.0, 0.0, z), 3.0));
		EXPECT_TRUE(around.besideOthers());
		const double side = z > 0.0 ? 1.0 : -1.0;
		EXPECT_GT(side * around.side().z(), 0.9);
		for (int k = 0; k < around.size(); ++k)
			EXPECT_GT(side * around.normal(k).z(), 0.0);
	}
}

TEST(ControlNeighborhood, FarFromThePointsThereIsNoSurface)
{
	const PointCloud          cloud = planeCloud(1500);
	const std::vector<double> spacing(cloud.size(), 1.0 / std::sqrt(1500.0));
	const ControlPoints       control(cloud, spacing);
	ControlNeighborhood       around;
	EXPECT_TRUE(around.gather(control, Vector3d(0, 0, 2.5 * spacing[0]), 4.0));
	EXPECT_FALSE(around.besideOthers());
	EXPECT_FALSE(around.gather(control, Vector3d(0, 0, 4.0 * spacing[0]), 4.0));
}

} // namespace
} // namespace curvature_lines
