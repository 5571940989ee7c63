// One patch of the denoising: exact on quadrics for every kind of support, arc lengths on a circle, gates and limits.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "covering_patch.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "spatial_order.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Support = BlendOptions::Support;

// Points of the paraboloid z = (x^2 - y^2 / 2) / 4 over a square, with its normals.
PointCloud paraboloid(int points, double noise)
{
	samples::Random random(1, 0);
	PointCloud      cloud;
	cloud.positions.resize(3, points);
	cloud.normals.resize(3, points);
	for (int k = 0; k < points; ++k) {
		const double   x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
		const Vector3d n       = Vector3d(-0.5 * x, 0.25 * y, 1.0).normalized();
		cloud.positions.col(k) = Vector3d(x, y, 0.25 * (x * x - 0.5 * y * y));
		cloud.positions.col(k) += noise * random.normal() * n;
		cloud.normals.col(k) = n;
	}
	return cloud;
}

BlendInput inputOf(const PointCloud& cloud, double noise)
{
	SpatialOrder order(cloud.positions);
	PointCloud   arranged{order.arrange(cloud.positions), order.arrange(cloud.normals)};
	const double spacing = 2.0 / std::sqrt(double(cloud.size()));
	return {
		std::move(order),
		std::move(arranged),
		std::vector<double>(cloud.size(), spacing),
		std::vector<double>(cloud.size(), noise)};
}

Index nearestToOrigin(const Matrix3Xd& positions)
{
	Index found = 0;
	positions.colwise().squaredNorm().minCoeff(&found);
	return found;
}

TEST(CoveringPatch, LiesOnTheSurfaceForEverySupport)
{
	const BlendInput input = inputOf(paraboloid(3000, 0.0), 1e-6);
	const BlendGuide guide(input.cloud.positions, input.cloud.normals);
	const Index      i = nearestToOrigin(guide.positions);
	for (const Support support : {Support::Free, Support::OneFace, Support::ArcLength}) {
		BlendOptions options;
		options.support = support;
		options.radius.assign(input.cloud.size(), 0.3);
		const CoveringPatch patch = coveringPatchAt(input, guide, options, i);
		ASSERT_TRUE(patch.surface.valid);
		EXPECT_LT((patch.surface.normal(0.0, 0.0) - guide.normals.col(i)).norm(), 0.02);
		// k1 + k2 = -1/4 over 2: convex is positive, the normal points up
		EXPECT_NEAR(patch.surface.meanCurvature(), -0.125, 0.02);
		EXPECT_LT(patch.surface.scale, 1e-3);
		EXPECT_EQ(patch.purity, 1.0); // was not asked for
	}
}

TEST(CoveringPatch, ScaleIsTheNoiseAndPurityFallsWhereItIsMore)
{
	const double     noise = 0.01;
	const PointCloud cloud = paraboloid(4000, noise);
	const BlendInput input = inputOf(cloud, noise), understated = inputOf(cloud, 0.5 * noise);
	const BlendGuide guide(input.cloud.positions, input.cloud.normals);
	const Index      i = nearestToOrigin(guide.positions);
	BlendOptions     options;
	options.purity = 0.5;
	options.radius.assign(input.cloud.size(), 0.3);
	const CoveringPatch patch = coveringPatchAt(input, guide, options, i);
	const CoveringPatch doubt = coveringPatchAt(understated, guide, options, i);
	ASSERT_TRUE(patch.surface.valid && doubt.surface.valid);
	EXPECT_NEAR(patch.surface.scale, noise, 0.15 * noise);
	EXPECT_GT(patch.purity, 0.5);
	EXPECT_LT(doubt.purity, 1e-2);
}

TEST(CoveringPatch, ArcCoordinatesAreArcLengths)
{
	// A unit circle around (0, 0, -1): at an angle t the point (sin t, 0, cos t - 1) with normal (sin t, 0, cos t).
	const double       radius = 0.5;
	const SurfacePatch patch(Vector3d::Zero(), Vector3d::UnitZ(), radius);
	for (const double t : {-1.2, -0.6, 0.1, 0.4, 1.0}) {
		const Vector3d       place(std::sin(t), 0.0, std::cos(t) - 1.0);
		const Vector3d       normal(std::sin(t), 0.0, std::cos(t));
		const Vector3d       height = place + 0.1 * Vector3d::UnitZ();
		const ArcCoordinates arc    = arcCoordinates(patch, height, place, normal);
		ASSERT_TRUE(arc.valid) << t;
		const Eigen::Vector2d p     = patch.frame.toPlane(place).normalized();
		const double          along = Eigen::Vector2d(arc.x, arc.y).dot(p) * radius;
		EXPECT_NEAR(along, std::abs(t), 1e-5) << t;
		EXPECT_NEAR(arc.z, height.z(), 1e-12);
	}
	// Turned by more than about 70 degrees, and by more than a right angle.
	for (const double t : {1.3, 2.0})
		EXPECT_FALSE(arcCoordinates(
						 patch,
						 Vector3d::Zero(),
						 Vector3d(std::sin(t), 0.0, std::cos(t) - 1.0),
						 Vector3d(std::sin(t), 0.0, std::cos(t)))
		                 .valid);
}

TEST(CoveringPatch, NormalWeightQuartersAtOneWidthAndEnds)
{
	EXPECT_EQ(normalWeight(0.0), 1.0);
	EXPECT_EQ(normalWeight(1.0), 0.25);
	double before = 1.0;
	for (double e2 = 0.1; e2 < 4.0; e2 += 0.1) {
		EXPECT_LT(normalWeight(e2), before);
		before = normalWeight(e2);
	}
	EXPECT_GT(before, 0.0);
	EXPECT_EQ(normalWeight(4.0), 0.0);
}

TEST(CoveringPatch, LimitsGrowWithTheNoise)
{
	const PointCloud cloud = paraboloid(100, 0.0);
	const BlendInput calm = inputOf(cloud, 0.001), noisy = inputOf(cloud, 0.01);
	EXPECT_NEAR(farthestMove(noisy, 3) - farthestMove(calm, 3), 10.0 * 0.009, 1e-12);
	BlendOptions options;
	EXPECT_GT(ballRadius(noisy, options, 0.2, 3), ballRadius(calm, options, 0.2, 3));
	EXPECT_NEAR(ballRadius(noisy, options, 0.2, 3), std::hypot(0.2, 3.0 * 0.01), 1e-12);
	options.support = Support::OneFace; // its guide has no noise
	EXPECT_EQ(ballRadius(noisy, options, 0.2, 3), 0.2);
}

} // namespace
} // namespace curvature_lines::test
