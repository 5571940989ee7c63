// The moving-least-squares surface of exact clouds: planes exactly, spheres closely, and a projection that stays.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "control_neighborhood.h"
#include "moving_least_squares.h"
#include "point_cloud.h"
#include "point_set_surface.h"
#include "spatial_order.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// So that the places of the index's order are the points themselves.
PointCloud inOrder(const PointCloud& points)
{
	const SpatialOrder order(points.positions);
	return {order.arrange(points.positions), order.arrange(points.normals)};
}

struct Surface {
	CloudIndex                index;
	ControlPoints             control;
	MovingLeastSquaresSurface surface;

	explicit Surface(const PointCloud& points) :
			index(inOrder(points)), control(index, index.spacing()), surface(control)
	{
	}
};

PointCloud cloudOf(const char* name, int points, double noise = 0.0)
{
	samples::SampleRequest request;
	request.surface   = name;
	request.points    = points;
	request.noise     = noise;
	request.seed      = 6;
	const auto sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

TEST(MovingLeastSquares, APlaneIsExact)
{
	const Surface    plane(cloudOf("plane", 2000));
	samples::Random  random(1, 0);
	Eigen::Matrix3Xd places(3, 100);
	for (int k = 0; k < 100; ++k)
		places.col(k) << random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
			random.uniform(-0.02, 0.02);
	const ProjectedPoints projected = projectPoints(plane.surface, places);
	for (int k = 0; k < 100; ++k) {
		ASSERT_TRUE(projected.projected[k]);
		EXPECT_NEAR(projected.positions(2, k), 0.0, 1e-9);
		EXPECT_LT((projected.positions.col(k) - places.col(k)).head<2>().norm(), 1e-6);
		EXPECT_NEAR(projected.normals(2, k), 1.0, 1e-9);
	}
}

TEST(MovingLeastSquares, OfASphereIsRoundAndStays)
{
	const Surface    sphere(cloudOf("sphere", 4000));
	samples::Random  random(2, 0);
	Eigen::Matrix3Xd places(3, 200);
	for (int k = 0; k < 200; ++k)
		places.col(k) = random.uniform(0.96, 1.04) * random.normal3().normalized();
	const ProjectedPoints projected = projectPoints(sphere.surface, places);
	for (int k = 0; k < 200; ++k) {
		ASSERT_TRUE(projected.projected[k]);
		EXPECT_NEAR(projected.positions.col(k).norm(), 1.0, 1e-3);
		EXPECT_GT(projected.normals.col(k).dot(projected.positions.col(k).normalized()), 0.999);
	}
	const ProjectedPoints again = projectPoints(sphere.surface, projected.positions);
	EXPECT_LT((again.positions - projected.positions).colwise().norm().maxCoeff(), 1e-4);
}

TEST(MovingLeastSquares, IsCloserThanNoisyPoints)
{
	const PointCloud      noisy = cloudOf("sphere", 4000, 0.005);
	const Surface         sphere(noisy);
	const ProjectedPoints projected = projectPoints(sphere.surface, noisy.positions);
	const auto            error     = [](const Eigen::Matrix3Xd& p) {
        return std::sqrt((p.colwise().norm().array() - 1.0).square().mean());
	};
	EXPECT_LT(error(projected.positions), 0.6 * error(noisy.positions));
}

TEST(MovingLeastSquares, FarFromThePointsThereIsNone)
{
	const Surface          sphere(cloudOf("sphere", 2000));
	const Eigen::Matrix3Xd places    = Vector3d(0, 0, 3).replicate(1, 1);
	const ProjectedPoints  projected = projectPoints(sphere.surface, places);
	EXPECT_FALSE(projected.projected[0]);
	EXPECT_EQ(projected.positions, places);
}

TEST(MovingLeastSquares, MovesWithTheCloud)
{
	const PointCloud        cloud = cloudOf("torus", 3000, 0.003);
	const test::RigidMotion motion;
	const Surface           here(cloud);
	const Surface there({motion.ofPoints(cloud.positions), motion.ofVectors(cloud.normals)});
	const Eigen::Matrix3Xd places = cloud.positions.leftCols(100);
	const ProjectedPoints  a      = projectPoints(here.surface, places);
	const ProjectedPoints  b      = projectPoints(there.surface, motion.ofPoints(places));
	EXPECT_EQ(a.projected, b.projected);
	std::vector<double> apart;
	for (int k = 0; k < 100; ++k)
		apart.push_back((motion.ofPoints(a.positions.col(k)) - b.positions.col(k)).norm());
	std::sort(apart.begin(), apart.end());
	EXPECT_LT(apart[50], 1e-9);
	// Where rounding decides about one step more, as far as a step that is still taken, of some 0.05 spacings.
	EXPECT_LT(apart[99], 2e-3);
}

} // namespace
} // namespace curvature_lines
