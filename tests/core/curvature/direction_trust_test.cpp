// What directions weigh, against their standard deviation, and the turning of exact fields.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "direction_trust.h"
#include "exact_field.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

test::ExactCloud exact(const char* surface, int points, bool regular = false)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.seed    = 5;
	request.regular = regular;
	return test::exactCloud(request);
}

Eigen::VectorXd anglesOf(const test::ExactCloud& exact)
{
	Eigen::VectorXd theta(exact.cloud.size());
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const Eigen::Vector2d d =
			TangentFrame(exact.cloud.normals.col(i)).toPlane(exact.field.d1.col(i));
		theta[i] = std::atan2(d.y(), d.x());
	}
	return theta;
}

DirectionTrust trustOf(const test::ExactCloud& exact)
{
	return directionTrust(exact.cloud, exact.field, anglesOf(exact));
}

TEST(DirectionTrust, WeightIsTheSquareOfTheDifferenceInErrors)
{
	test::ExactCloud torus = exact("torus", 2000, true); // no point is beside a gap
	torus.field.error.setConstant(0.2);
	const Eigen::VectorXd weight = trustOf(torus).weight;
	torus.field.error.setConstant(0.4);
	const Eigen::VectorXd less = trustOf(torus).weight;
	for (Index i = 0; i < torus.cloud.size(); ++i) {
		const double difference = torus.field.k1[i] - torus.field.k2[i];
		// (difference / error)^2 over that of a sure direction, six errors; bounded by 100
		const double ratio = std::pow(difference / (6.0 * 0.2), 2);
		EXPECT_NEAR(weight[i], ratio / (1.0 + ratio / 100.0), 1e-9 * (1.0 + ratio));
		EXPECT_LT(less[i], weight[i]);
	}
}

TEST(DirectionTrust, WithoutErrorsTheAnisotropyCounts)
{
	const test::ExactCloud sphere = exact("sphere", 1500);
	EXPECT_NEAR(trustOf(sphere).weight.cwiseAbs().maxCoeff(), 0.0, 1e-12);
	const test::ExactCloud cylinder = exact("cylinder", 2000);
	EXPECT_NEAR(trustOf(cylinder).weight.minCoeff(), 1.0, 1e-9);
	test::ExactCloud failed = cylinder;
	failed.field.status[7]  = PointStatus::TooFewNeighbors;
	failed.field.status[8]  = PointStatus::Invalid;
	const auto weight       = trustOf(failed).weight;
	EXPECT_EQ(weight[7], 0.0);
	EXPECT_EQ(weight[8], 0.0);
	EXPECT_GT(weight[9], 0.0);
}

TEST(DirectionTrust, DirectionsAtRimsAreInDoubt)
{
	test::ExactCloud cylinder = exact("cylinder", 4000);
	cylinder.field.error.setConstant(0.1);
	const Eigen::VectorXd weight = trustOf(cylinder).weight;
	double                atRim = 0.0, inside = 0.0;
	Index                 rims = 0, insides = 0;
	for (Index i = 0; i < cylinder.cloud.size(); ++i) {
		const double z = std::abs(cylinder.cloud.positions(2, i));
		if (z > 0.98) {
			atRim += weight[i];
			++rims;
		}
		else if (z < 0.5) {
			inside += weight[i];
			++insides;
		}
	}
	EXPECT_LT(atRim / rims, 0.2 * inside / insides);
}

// The lines of a cylinder are parallel; those around the axis of a torus turn by their geodesic curvature.
TEST(DirectionTrust, TurningIsThatOfTheField)
{
	const test::ExactCloud cylinder = exact("cylinder", 4000);
	const auto             straight = trustOf(cylinder).turning;
	for (Index i = 0; i < cylinder.cloud.size(); ++i)
		EXPECT_LT(straight.col(i).norm(), 0.05);
	test::ExactCloud torus = exact("torus", 6000);
	torus.field.error.setConstant(0.01); // sure directions: doubt makes the turning smaller
	const auto turning = trustOf(torus).turning;
	double     error = 0.0, size = 0.0;
	for (Index i = 0; i < torus.cloud.size(); ++i) {
		const Vector3d p      = torus.cloud.positions.col(i);
		const Vector3d around = Vector3d::UnitZ().cross(p).normalized();
		// sin(v) / rho, v the angle around the tube
		const double geodesic = (p.z() / 0.4) / p.head<2>().norm();
		EXPECT_NEAR(turning.col(i).dot(torus.cloud.normals.col(i)), 0.0, 1e-6);
		error += std::pow(std::abs(turning.col(i).dot(around)) - std::abs(geodesic), 2);
		size += geodesic * geodesic;
	}
	EXPECT_LT(std::sqrt(error / size), 0.15);
}

TEST(TransportAngle, IsThatOfTheSmallestRotation)
{
	samples::Random random(3, 0);
	for (int k = 0; k < 200; ++k) {
		const Vector3d n = random.normal3().normalized(),
					   m = (n + 0.7 * random.normal3()).normalized();
		if (n.dot(m) < 0.2)
			continue;
		const TangentFrame a(n), b(m);
		const auto         rotation = Eigen::Quaterniond::FromTwoVectors(n, m);
		const double       theta    = random.uniform(-3.0, 3.0);
		const Vector3d     d        = rotation * (std::cos(theta) * a.u + std::sin(theta) * a.v);
		const double       there    = std::atan2(d.dot(b.v), d.dot(b.u));
		EXPECT_NEAR(
			std::remainder(theta - there - transportAngle(a, b), 2.0 * EIGEN_PI), 0.0, 1e-9);
	}
}

} // namespace
} // namespace curvature_lines
