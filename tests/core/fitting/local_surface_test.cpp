// Height and normal polynomials in a ball: exact on surfaces that are such polynomials, whatever their pose and size;
// what opposes or lies far off does not count.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_surface.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// z = a polynomial of degree 2, or 4 with `quartic`, over the unit disk.
struct Graph {
	double quartic;

	double z(double x, double y) const
	{
		return 0.1 + 0.2 * x - 0.1 * y + 0.3 * x * x - 0.2 * x * y + 0.1 * y * y +
		       quartic * (x * x * x - 0.5 * x * y * y + x * x * y * y - 0.3 * y * y * y * y);
	}
	Vector3d normal(double x, double y) const
	{
		const double h = 1e-5;
		return Vector3d(
				   (z(x - h, y) - z(x + h, y)) / (2.0 * h),
				   (z(x, y - h) - z(x, y + h)) / (2.0 * h),
				   1.0)
		    .normalized();
	}
	// The change of the normal per step in x and y, and the steps in space.
	void steps(Vector3d dn[2], Vector3d dp[2]) const
	{
		const double h = 1e-4;
		dn[0]          = normal(h, 0.0) - normal(-h, 0.0);
		dn[1]          = normal(0.0, h) - normal(0.0, -h);
		dp[0]          = Vector3d(2.0 * h, 0.0, z(h, 0.0) - z(-h, 0.0));
		dp[1]          = Vector3d(0.0, 2.0 * h, z(0.0, h) - z(0.0, -h));
	}
	PointCloud sample(int count, int seed) const
	{
		samples::Random random(seed, 0);
		PointCloud      cloud;
		cloud.positions.resize(3, count);
		cloud.normals.resize(3, count);
		for (int k = 0; k < count; ++k) {
			const double x = random.uniform(-0.6, 0.6), y = random.uniform(-0.6, 0.6);
			cloud.positions.col(k) = Vector3d(x, y, z(x, y));
			cloud.normals.col(k)   = normal(x, y);
		}
		return cloud;
	}
};

std::vector<Index> all(const PointCloud& cloud)
{
	std::vector<Index> points(cloud.size());
	std::iota(points.begin(), points.end(), 0);
	return points;
}

SurfaceElement heights(
	const PointCloud& cloud,
	const Vector3d&   center,
	double            radius,
	const Vector3d&   normal,
	int               degree,
	int               iterations)
{
	LocalSurfaceFitter& fitter = LocalSurfaceFitter::ofThisThread();
	fitter.takeBall(cloud, all(cloud), center, radius);
	return fitter.fitHeights(normal, degree, iterations);
}

void expectIsGraph(const SurfaceElement& element, const Graph& graph)
{
	ASSERT_TRUE(element.valid);
	EXPECT_LT((element.position - Vector3d(0.0, 0.0, graph.z(0.0, 0.0))).norm(), 1e-7);
	EXPECT_LT((element.normal - graph.normal(0.0, 0.0)).norm(), 1e-6);
	EXPECT_LT((element.shape * element.normal).norm(), 1e-7);
	EXPECT_LT((element.shape - element.shape.transpose()).norm(), 1e-9);
	Vector3d dn[2], dp[2];
	graph.steps(dn, dp);
	for (int step = 0; step < 2; ++step)
		EXPECT_LT((element.shape * dp[step] - dn[step]).norm(), 1e-4 * dp[step].norm());
	EXPECT_LT(element.residual, 1e-5); // the root of what the fit adds to its diagonal
}

TEST(LocalSurface, HeightsAreExactOnPolynomialsOfTheirDegree)
{
	for (const int degree : {2, 4}) {
		const Graph graph{degree == 4 ? 0.2 : 0.0};
		expectIsGraph(
			heights(graph.sample(120, 1), Vector3d::Zero(), 1.0, Vector3d::UnitZ(), degree, 1),
			graph);
	}
}

TEST(LocalSurface, FollowsARigidMotionAndTheSize)
{
	const Graph           graph{0.1};
	const PointCloud      cloud = graph.sample(150, 2);
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
	const Vector3d shift(3.0, -2.0, 1.0);
	const double   size  = 0.01;
	PointCloud     moved = cloud;
	moved.positions      = (size * turn * cloud.positions).colwise() + shift;
	moved.normals        = turn * cloud.normals;
	const auto a         = heights(cloud, Vector3d(0.05, 0.0, 0.1), 0.7, Vector3d::UnitZ(), 4, 3);
	const auto b         = heights(
        moved,
        size * turn * Vector3d(0.05, 0.0, 0.1) + shift,
        size * 0.7,
        turn * Vector3d::UnitZ(),
        4,
        3);
	ASSERT_TRUE(a.valid && b.valid);
	EXPECT_LT((size * turn * a.position + shift - b.position).norm(), 1e-9 * size);
	EXPECT_LT((turn * a.normal - b.normal).norm(), 1e-7);
	EXPECT_LT((turn * a.shape * turn.transpose() - size * b.shape).norm(), 1e-6);
	EXPECT_NEAR(size * a.residual, b.residual, 1e-8 * size);
	EXPECT_EQ(a.samples, b.samples);
}

TEST(LocalSurface, ASheetThatOpposesDoesNotCount)
{
	const Graph      graph{0.0};
	const PointCloud cloud = graph.sample(100, 3);
	PointCloud       both;
	both.positions.resize(3, 200);
	both.normals.resize(3, 200);
	both.positions << cloud.positions, cloud.positions.colwise() - Vector3d(0.0, 0.0, 0.15);
	both.normals << cloud.normals, -cloud.normals;
	const auto alone =
		heights(cloud, Vector3d::Zero(), 0.9, Vector3d(0.1, 0.1, 1.0).normalized(), 2, 2);
	const auto beside =
		heights(both, Vector3d::Zero(), 0.9, Vector3d(0.1, 0.1, 1.0).normalized(), 2, 2);
	ASSERT_TRUE(alone.valid && beside.valid);
	EXPECT_EQ(alone.samples, beside.samples);
	EXPECT_LT((alone.position - beside.position).norm(), 1e-12);
	EXPECT_LT((alone.shape - beside.shape).norm(), 1e-10);
}

TEST(LocalSurface, PointsFarOffTheSurfaceLoseTheirWeight)
{
	const Graph      graph{0.0};
	const PointCloud clean = graph.sample(200, 4);
	PointCloud       dirty = clean;
	for (int k = 0; k < 200; k += 20)
		dirty.positions(2, k) += 0.4;
	const auto expected = heights(clean, Vector3d::Zero(), 1.0, Vector3d::UnitZ(), 2, 12);
	const auto once     = heights(dirty, Vector3d::Zero(), 1.0, Vector3d::UnitZ(), 2, 1);
	const auto often    = heights(dirty, Vector3d::Zero(), 1.0, Vector3d::UnitZ(), 2, 12);
	ASSERT_TRUE(expected.valid && once.valid && often.valid);
	EXPECT_LT((once.position - expected.position).norm(), 0.02);
	// Plain least squares would move by about 0.4 / 10. In the tilted frame the surface is no exact quadric.
	EXPECT_LT((often.position - expected.position).norm(), 3e-3);
	EXPECT_LT((often.shape - expected.shape).norm(), 2e-2);
}

// On a sphere the normal is a linear function of the place: exact at every degree.
TEST(LocalSurface, NormalsOfASphereTurnByItsCurvature)
{
	samples::Random random(5, 0);
	const double    r = 2.0;
	PointCloud      cloud;
	cloud.positions.resize(3, 80);
	cloud.normals.resize(3, 80);
	for (int k = 0; k < 80; ++k) {
		const Vector3d n =
			Vector3d(random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), 1.0).normalized();
		cloud.positions.col(k) = r * n;
		cloud.normals.col(k)   = n;
	}
	SurfaceElement start;
	start.position = Vector3d(0.0, 0.0, r);
	start.normal   = Vector3d::UnitZ();
	start.residual = 0.25;
	for (const int degree : {1, 2, 3})
		for (const bool robust : {false, true}) {
			LocalSurfaceFitter& fitter = LocalSurfaceFitter::ofThisThread();
			fitter.takeBall(cloud, all(cloud), start.position, 0.8);
			const SurfaceElement element = fitter.fitNormals(start, degree, robust);
			ASSERT_TRUE(element.valid);
			const Matrix3d expected = Vector3d(1.0 / r, 1.0 / r, 0.0).asDiagonal();
			EXPECT_LT((element.shape - expected).norm(), 1e-7) << degree << robust;
			EXPECT_LT((element.normal - Vector3d::UnitZ()).norm(), 1e-7);
			EXPECT_EQ(element.residual, start.residual);
		}
}

TEST(LocalSurface, PlaneHasTheSideOfTheNormalsAndAHeight)
{
	samples::Random    random(6, 0);
	const Vector3d     n = Vector3d(1.0, 2.0, -1.0).normalized();
	const TangentFrame frame(n);
	PointCloud         cloud;
	cloud.positions.resize(3, 50);
	cloud.normals.resize(3, 50);
	for (int k = 0; k < 50; ++k) {
		const Vector2d p(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
		cloud.positions.col(k) = 0.1 * n + frame.toSpace(p);
		cloud.normals.col(k)   = (n + 0.1 * random.normal3()).normalized();
	}
	LocalSurfaceFitter& fitter = LocalSurfaceFitter::ofThisThread();
	fitter.takeBall(cloud, all(cloud), Vector3d::Zero(), 0.5);
	const BallPlane plane = fitter.plane((n + Vector3d(0.3, 0.0, 0.0)).normalized());
	EXPECT_LT((plane.normal - n).norm(), 1e-6);
	EXPECT_NEAR(plane.height, 0.1, 1e-7);
	EXPECT_EQ(fitter.plane(-n).normal, Vector3d::Zero()); // all oppose
}

TEST(LocalSurface, IsInvalidWithoutEnoughPointsOrNormal)
{
	const PointCloud few = Graph{0.0}.sample(8, 7);
	EXPECT_FALSE(heights(few, Vector3d::Zero(), 1.0, Vector3d::UnitZ(), 2, 1).valid);
	const PointCloud many = Graph{0.0}.sample(60, 7);
	EXPECT_FALSE(heights(many, Vector3d::Zero(), 1.0, Vector3d::Zero(), 2, 1).valid);
	EXPECT_FALSE(heights(many, Vector3d(5.0, 0.0, 0.0), 1.0, Vector3d::UnitZ(), 2, 1).valid);
	EXPECT_TRUE(heights(many, Vector3d::Zero(), 1.0, Vector3d::UnitZ(), 2, 1).valid);
}

} // namespace
} // namespace curvature_lines::test
