// Networks of exact crease points: boxes with twelve curves and eight corners, curves without ends, junctions, and
// invariance.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "crease_curves.h"
#include "crease_network.h"
#include "crease_points.h"
#include "crease_tracing.h"
#include "exact_creases.h"
#include "point_cloud.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.03;

Creases networkOf(const CreasePoints& points)
{
	CreaseTracing tracing(points);
	return creaseNetwork(
		tracing, tracing.traceAll(0.7 * spacing, 0.5), 0.7 * spacing, 0.7 * spacing);
}

TEST(CreaseNetwork, OfABoxIsItsEdgesAndCorners)
{
	const Vector3d half(0.5, 0.4, 0.3);
	const Creases  box = networkOf(test::boxCreases(half, spacing));
	ASSERT_EQ(box.curves.size(), 12u);
	ASSERT_EQ(box.corners.size(), 8u);
	std::vector<double> lengths;
	for (const CreaseCurve& curve : box.curves) {
		lengths.push_back(curve.length());
		EXPECT_FALSE(curve.closed);
		EXPECT_NE(curve.start, curve.end);
		for (const Index corner : {curve.start, curve.end})
			ASSERT_GE(corner, 0);
		EXPECT_NEAR(curve.angle.minCoeff(), EIGEN_PI / 2.0, 1e-6);
		EXPECT_NEAR(curve.angle.maxCoeff(), EIGEN_PI / 2.0, 1e-6);
		const double even = curve.length() / (curve.size() - 1);
		EXPECT_NEAR(even, 0.7 * spacing, 0.1 * spacing);
		for (Index v = 0; v < curve.size(); ++v) {
			// Two coordinates lie on faces of the box: those of the two normals.
			const Vector3d p = curve.positions.col(v);
			for (const auto* normals : {&curve.left, &curve.right})
				EXPECT_NEAR(
					normals->col(v).dot(p), half.dot(normals->col(v).cwiseAbs()), 1e-3 * spacing);
			EXPECT_LT(
				(Vector3d(curve.left.col(v).cross(curve.right.col(v))) - curve.tangents.col(v))
					.norm(),
				1e-6);
		}
	}
	EXPECT_TRUE(std::is_sorted(lengths.rbegin(), lengths.rend()));
	for (int k = 0; k < 12; ++k)
		EXPECT_NEAR(lengths[k], 2.0 * half[k / 4], 1e-4);
	for (const CreaseCorner& corner : box.corners) {
		EXPECT_EQ(corner.curves.size(), 3u);
		EXPECT_LT((corner.position.cwiseAbs() - half).norm(), 1e-4);
	}
}

TEST(CreaseNetwork, OfANoisyBoxIsTheSame)
{
	const Creases box = networkOf(test::boxCreases({0.5, 0.4, 0.3}, spacing, 0.1 * spacing));
	EXPECT_EQ(box.curves.size(), 12u);
	ASSERT_EQ(box.corners.size(), 8u);
	for (const CreaseCorner& corner : box.corners)
		EXPECT_LT((corner.position.cwiseAbs() - Vector3d(0.5, 0.4, 0.3)).norm(), 0.5 * spacing);
}

TEST(CreaseNetwork, AClosedCurveHasNoCorner)
{
	const Creases circle = networkOf(test::circularCrease(0.5, spacing));
	ASSERT_EQ(circle.curves.size(), 1u);
	EXPECT_TRUE(circle.corners.empty());
	const CreaseCurve& curve = circle.curves[0];
	EXPECT_TRUE(curve.closed);
	EXPECT_EQ(curve.start, -1);
	EXPECT_EQ(curve.end, -1);
	EXPECT_NEAR(curve.length(), EIGEN_PI, 0.01);
	for (Index v = 0; v < curve.size(); ++v)
		EXPECT_NEAR(curve.positions.col(v).norm(), 0.5, 0.05 * spacing);
}

TEST(CreaseNetwork, ACreaseThatFadesEndsWithoutACorner)
{
	CreasePoints    points;
	samples::Random random(2, 0);
	test::addStraightCrease(
		points, {0, 0, 0}, {1, 0, 0}, Vector3d::UnitY(), Vector3d::UnitZ(), spacing, random);
	const Creases found = networkOf(points);
	ASSERT_EQ(found.curves.size(), 1u);
	EXPECT_TRUE(found.corners.empty());
	EXPECT_NEAR(found.curves[0].length(), 1.0, 2.0 * spacing);
	EXPECT_EQ(found.curves[0].start, -1);
	EXPECT_EQ(found.curves[0].end, -1);
}

// The edge between two walls meets a third in the middle of its own edge: it is cut there.
TEST(CreaseNetwork, ACreaseThatAnotherMeetsIsCutThere)
{
	CreasePoints    points;
	samples::Random random(3, 0);
	const Vector3d  up = Vector3d::UnitZ(), x = Vector3d::UnitX(), y = Vector3d::UnitY();
	test::addStraightCrease(points, {-0.5, 0, 0}, {0.5, 0, 0}, y, up, spacing, random);
	test::addStraightCrease(points, {0, 0.01, 0}, {0, 0.6, 0}, up, x, spacing, random);
	const Creases found = networkOf(points);
	ASSERT_EQ(found.curves.size(), 3u);
	ASSERT_EQ(found.corners.size(), 1u);
	EXPECT_EQ(found.corners[0].curves.size(), 3u);
	EXPECT_LT(found.corners[0].position.norm(), 0.5 * spacing);
}

TEST(CreaseNetwork, MovesAndGrowsWithTheCloud)
{
	const test::RigidMotion motion;
	const CreasePoints      points = test::boxCreases({0.5, 0.4, 0.3}, spacing, 0.05 * spacing);
	CreasePoints            moved  = points;
	for (CreasePoint& p : moved.points) {
		p.position = 10.0 * (motion.rotation * p.position + motion.translation);
		p.tangent  = motion.rotation * p.tangent;
		p.left     = motion.rotation * p.left;
		p.right    = motion.rotation * p.right;
		p.spacing *= 10.0;
	}
	moved.faceDeviation *= 10.0;
	const Creases here = networkOf(points);
	CreaseTracing tracing(moved);
	const Creases there =
		creaseNetwork(tracing, tracing.traceAll(7.0 * spacing, 0.5), 7.0 * spacing, 7.0 * spacing);
	ASSERT_EQ(here.curves.size(), there.curves.size());
	ASSERT_EQ(here.corners.size(), there.corners.size());
	for (const CreaseCorner& corner : here.corners) {
		const Vector3d expected = 10.0 * (motion.rotation * corner.position + motion.translation);
		EXPECT_TRUE(std::any_of(there.corners.begin(), there.corners.end(), [&](const auto& c) {
			return (c.position - expected).norm() < 1e-3;
		}));
	}
}

TEST(CreaseNetwork, OfNothingIsEmpty)
{
	const Creases none = networkOf({});
	EXPECT_TRUE(none.curves.empty());
	EXPECT_TRUE(none.corners.empty());
}

} // namespace
} // namespace curvature_lines
