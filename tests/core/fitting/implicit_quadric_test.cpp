// Implicit quadrics through points of exact quadrics, and their distances beside true ones.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "implicit_quadric.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd cylinder(double radius, int n, samples::Random& random)
{
	Matrix3Xd points(3, n);
	for (int i = 0; i < n; ++i) {
		const double angle = random.uniform(0.0, 2.0 * EIGEN_PI);
		points.col(i) << radius * std::cos(angle), radius * std::sin(angle),
			random.uniform(-1.0, 1.0);
	}
	return points;
}

Eigen::Isometry3d someMotion()
{
	Eigen::Isometry3d motion(Eigen::AngleAxisd(0.8, Vector3d(1.0, -2.0, 0.5).normalized()));
	motion.translation() = Vector3d(0.2, -0.1, 0.3);
	return motion;
}

TEST(ImplicitQuadric, PassesThroughAQuadricOfAnyPlaceAndDirection)
{
	samples::Random         random(3, 0);
	const Eigen::Isometry3d motion = someMotion();
	Matrix3Xd               points = cylinder(0.5, 30, random);
	points = (motion.linear() * points).colwise() + Vector3d(motion.translation());
	const ImplicitQuadricFit fit = fitImplicitQuadrics(points);
	ASSERT_TRUE(fit.valid);
	EXPECT_LT(fit.deviations[0], 1e-6);
	EXPECT_TRUE(std::is_sorted(fit.deviations.begin(), fit.deviations.end()));
	for (int k = 0; k < 20; ++k) {
		const double   angle = random.uniform(0.0, 6.0), z = random.uniform(-1.0, 1.0);
		const Vector3d on = motion * Vector3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), z);
		EXPECT_LT(fit.quadrics[0].distance(on), 1e-5);
	}
}

TEST(ImplicitQuadric, DistanceIsNeverAboveTheTrueOneAndNearItClose)
{
	samples::Random random(4, 0);
	const auto      fit     = fitImplicitQuadrics(cylinder(0.5, 40, random));
	const auto&     quadric = fit.quadrics[0];
	for (const double off : {-0.4, -0.1, -0.01, 0.01, 0.1, 0.4, 1.0}) {
		const double distance = quadric.distance(Vector3d(0.5 + off, 0.0, 0.3));
		EXPECT_LE(distance, std::abs(off) + 1e-5);
		EXPECT_GE(distance, 0.5 * std::abs(off));
	}
	EXPECT_NEAR(quadric.distance(Vector3d(0.51, 0.0, 0.0)), 0.01, 5e-4);
}

TEST(ImplicitQuadric, DeviationIsTheNoise)
{
	samples::Random random(5, 0);
	Matrix3Xd       points = cylinder(0.5, 4000, random);
	for (auto p : points.colwise()) {
		const Vector3d outward = Vector3d(p.x(), p.y(), 0.0).normalized();
		p += 0.01 * random.normal() * outward;
	}
	EXPECT_NEAR(fitImplicitQuadrics(points).deviations[0], 0.01, 0.001);
}

// The gradient vanishes along the edge, where |f| / |gradient| is no distance.
TEST(ImplicitQuadric, TwoPlanesAreOneQuadric)
{
	samples::Random random(6, 0);
	Matrix3Xd       points(3, 60);
	for (Eigen::Index i = 0; i < points.cols(); ++i) {
		const double along = random.uniform(0.0, 1.0), y = random.uniform(-1.0, 1.0);
		points.col(i) = i % 2 ? Vector3d(along, y, 0.0) : Vector3d(0.0, y, along);
	}
	const auto fit = fitImplicitQuadrics(points);
	EXPECT_LT(fit.deviations[0], 1e-6);
	EXPECT_LT(fit.quadrics[0].distance(Vector3d(0.0, 0.2, 0.0)), 1e-5);
	EXPECT_GT(fit.quadrics[0].distance(Vector3d(-0.3, 0.2, -0.3)), 0.1);
}

// A plane and any other plane through it: more than one quadric fits exactly.
TEST(ImplicitQuadric, PointsOfAPlaneDetermineNoSingleQuadric)
{
	samples::Random random(7, 0);
	Matrix3Xd       points(3, 40);
	for (auto p : points.colwise())
		p << random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0;
	const auto fit = fitImplicitQuadrics(points);
	EXPECT_LT(fit.deviations[1], 1e-4);
}

TEST(ImplicitQuadric, TooFewOrEqualPointsAreNoError)
{
	for (const int n : {0, 1, 5}) {
		const auto fit = fitImplicitQuadrics(Matrix3Xd::Zero(3, n));
		EXPECT_FALSE(std::isnan(fit.quadrics[0].distance(Vector3d(0.1, 0.2, 0.3))));
	}
}

} // namespace
} // namespace curvature_lines
