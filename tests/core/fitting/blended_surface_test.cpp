// The blend of patches over a cloud: noise goes, quadrics stay, residuals leave the point itself out.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "blended_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "covering_patch.h"
#include "point_cloud.h"
#include "spatial_order.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Points of the unit square of the plane z = 0, moved across it by noise.
PointCloud plane(int points, double noise)
{
	samples::Random random(2, 0);
	PointCloud      cloud;
	cloud.positions.resize(3, points);
	cloud.normals = Vector3d::UnitZ().replicate(1, points);
	for (int k = 0; k < points; ++k)
		cloud.positions.col(k) =
			Vector3d(random.uniform(), random.uniform(), noise * random.normal());
	return cloud;
}

struct Blending {
	BlendInput   input;
	BlendGuide   guide;
	BlendOptions options;

	Blending(const PointCloud& cloud, double noise, double radius) :
			input(inputOf(cloud, noise)), guide(input.cloud.positions, input.cloud.normals)
	{
		options.radius.assign(cloud.size(), radius);
	}
	std::vector<Index> all() const
	{
		std::vector<Index> targets(input.cloud.size());
		std::iota(targets.begin(), targets.end(), 0);
		return targets;
	}
	BlendedSurface operator()() const { return blendPatches(input, guide, options, all()); }

private:
	static BlendInput inputOf(const PointCloud& cloud, double noise)
	{
		SpatialOrder order(cloud.positions);
		PointCloud   arranged{order.arrange(cloud.positions), order.arrange(cloud.normals)};
		return {
			std::move(order),
			std::move(arranged),
			std::vector<double>(cloud.size(), 1.0 / std::sqrt(double(cloud.size()))),
			std::vector<double>(cloud.size(), noise)};
	}
};

double rms(const Eigen::VectorXd& values)
{
	return std::sqrt(values.squaredNorm() / double(values.size()));
}

TEST(BlendedSurface, RemovesNoiseAcrossAPlaneAndLeavesPointsInIt)
{
	const double         noise = 0.005;
	const Blending       blending(plane(3000, noise), noise, 0.15);
	const BlendedSurface blend  = blending();
	const Matrix3Xd&     before = blending.input.cloud.positions;
	EXPECT_LT(rms(blend.positions.row(2)), 0.35 * noise);
	EXPECT_LT((blend.positions.topRows(2) - before.topRows(2)).cwiseAbs().maxCoeff(), 0.5 * noise);
	EXPECT_GT(blend.normals.row(2).minCoeff(), 0.99);
	Index centers = static_cast<Index>(blend.center.size());
	ASSERT_GT(centers, 0);
	ASSERT_EQ(blend.variance.size(), blend.center.size());
	double variance = 0.0;
	for (const double v : blend.variance)
		variance += v;
	EXPECT_NEAR(std::sqrt(variance / centers), noise, 0.1 * noise);
}

TEST(BlendedSurface, APlaneStaysWhereItIs)
{
	const Blending       blending(plane(2000, 0.0), 1e-6, 0.15);
	const BlendedSurface blend = blending();
	EXPECT_LT((blend.positions - blending.input.cloud.positions).cwiseAbs().maxCoeff(), 1e-10);
	EXPECT_LT((blend.normals - blending.input.cloud.normals).cwiseAbs().maxCoeff(), 1e-8);
}

// The residual tells how far a point is from what the others say: its own pull on the patches is taken out.
TEST(BlendedSurface, ResidualsLeaveThePointItselfOut)
{
	PointCloud cloud = plane(1500, 0.0);
	Index      moved = 0;
	(cloud.positions.colwise() - Vector3d(0.5, 0.5, 0.0)).colwise().squaredNorm().minCoeff(&moved);
	const double height       = 0.01;
	cloud.positions(2, moved) = height;
	const Blending       blending(cloud, 1e-3, 0.12);
	const BlendedSurface blend = blending();
	for (Index k = 0; k < blending.input.cloud.size(); ++k)
		if (blending.input.cloud.positions(2, k) > 0.5 * height) {
			EXPECT_NEAR(blend.residual[k], height, 0.02 * height);
			EXPECT_LT(blend.positions(2, k), 0.2 * height);
		}
}

TEST(BlendedSurface, OnlyTheTargetsMove)
{
	const Blending           blending(plane(2000, 0.005), 0.005, 0.12);
	const std::vector<Index> targets = {3, 100, 101, 1500};
	const BlendedSurface     some =
		blendPatches(blending.input, blending.guide, blending.options, targets);
	const BlendedSurface all = blending();
	for (Index k = 0; k < 2000; ++k)
		if (std::find(targets.begin(), targets.end(), k) == targets.end()) {
			EXPECT_EQ(some.positions.col(k), blending.guide.positions.col(k));
			EXPECT_TRUE(std::isinf(some.residual[k]));
		}
		else {
			EXPECT_EQ(some.positions.col(k), all.positions.col(k));
			EXPECT_EQ(some.residual[k], all.residual[k]);
			EXPECT_EQ(some.purity[k], all.purity[k]);
		}
}

TEST(BlendedSurface, FollowsARigidMotionAndIsTheSameForAnyThreads)
{
	const PointCloud      cloud = plane(1500, 0.005);
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 2.0).normalized()).toRotationMatrix();
	const Blending       still(cloud, 0.005, 0.15);
	const BlendedSurface blend   = still();
	const int            threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const BlendedSurface alone = still();
	omp_set_num_threads(threads);
	EXPECT_EQ(blend.positions, alone.positions);
	EXPECT_EQ(blend.residual, alone.residual);

	// The same order of the points, so that the same are centres.
	Blending turned(cloud, 0.005, 0.15);
	turned.input.cloud.positions = turn * still.input.cloud.positions;
	turned.input.cloud.normals   = turn * still.input.cloud.normals;
	const BlendGuide     guide(turned.input.cloud.positions, turned.input.cloud.normals);
	const BlendedSurface moved = blendPatches(turned.input, guide, turned.options, turned.all());
	EXPECT_LT((turn * blend.positions - moved.positions).cwiseAbs().maxCoeff(), 1e-9);
	EXPECT_LT((turn * blend.normals - moved.normals).cwiseAbs().maxCoeff(), 1e-7);
}

} // namespace
} // namespace curvature_lines::test
