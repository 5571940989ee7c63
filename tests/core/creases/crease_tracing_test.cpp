// Curves through exact crease points: on the curve, along it, once each, and only as far as there are points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "crease_points.h"
#include "crease_tracing.h"
#include "exact_creases.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.03, step = 0.7 * spacing;

TEST(CreaseTracing, TheCurveNearAGuessIsTheCrease)
{
	const CreasePoints  points = test::circularCrease(0.5, spacing);
	const CreaseTracing tracing(points);
	samples::Random     random(1, 0);
	for (int k = 0; k < 50; ++k) {
		CreasePoint guess = points.points[random.index(points.points.size())];
		guess.position += 0.2 * spacing * random.normal3();
		const auto found = tracing.curveAt(guess);
		ASSERT_TRUE(found);
		EXPECT_NEAR(found->position.head<2>().norm(), 0.5, 0.05 * spacing);
		EXPECT_NEAR(found->position.z(), 0.0, 0.02 * spacing);
		const Vector3d along = Vector3d::UnitZ().cross(found->position).normalized();
		EXPECT_GT(std::abs(found->tangent.dot(along)), std::cos(0.03));
		EXPECT_GT(found->tangent.dot(guess.tangent), 0.9); // the way the guess goes
		EXPECT_NEAR(found->angle, EIGEN_PI / 2.0, 1e-6);
		EXPECT_NEAR(found->spacing, spacing, 1e-9);
	}
	CreasePoint far = points.points[0];
	far.position    = {3, 0, 0};
	EXPECT_FALSE(tracing.curveAt(far));
}

TEST(CreaseTracing, OneFaceAloneMakesNoCrease)
{
	CreasePoints points = test::circularCrease(0.5, spacing);
	for (CreasePoint& p : points.points) {
		if (p.fromLeft == (p.tangent.dot(Vector3d::UnitZ().cross(p.position)) > 0.0))
			continue;
		p          = p.reversed(); // whichever way round, the point is on the disc
		p.fromLeft = p.tangent.dot(Vector3d::UnitZ().cross(p.position)) > 0.0;
	}
	for (CreasePoint& p : points.points)
		p.fromLeft = p.tangent.dot(Vector3d::UnitZ().cross(p.position)) > 0.0;
	CreaseTracing tracing(points);
	EXPECT_FALSE(tracing.curveAt(points.points[0]));
	EXPECT_TRUE(tracing.traceAll(step, 0.5).empty());
}

TEST(CreaseTracing, FollowsEveryCurveOnce)
{
	CreasePoints       circle = test::circularCrease(0.5, spacing);
	const CreasePoints box    = test::boxCreases({2.0, 1.5, 1.0}, spacing);
	circle.points.insert(circle.points.end(), box.points.begin(), box.points.end());
	CreaseTracing tracing(circle);
	const auto    traces = tracing.traceAll(step, 0.5);
	EXPECT_EQ(traces.size(), 13u);
	EXPECT_EQ(
		std::count_if(traces.begin(), traces.end(), [](const auto& t) { return t.closed; }), 1);
	double length = 0.0;
	for (const CreaseTrace& trace : traces) {
		for (std::size_t v = 1; v < trace.vertices.size(); ++v) {
			const Vector3d d = trace.vertices[v].position - trace.vertices[v - 1].position;
			EXPECT_GT(d.dot(trace.vertices[v - 1].tangent), 0.5 * step);
			EXPECT_LT(d.norm(), 1.5 * step);
			length += d.norm();
		}
	}
	EXPECT_NEAR(length, EIGEN_PI + 4.0 * 2.0 * (2.0 + 1.5 + 1.0), 13.0 * 3.0 * spacing);
}

TEST(CreaseTracing, FindsNoCurveBelowTheSmallestAngle)
{
	const CreasePoints points = test::circularCrease(0.5, spacing); // 90 degrees
	EXPECT_TRUE(CreaseTracing(points).traceAll(step, 1.6).empty());
	EXPECT_EQ(CreaseTracing(points).traceAll(step, 1.5).size(), 1u);
}

TEST(CreaseTracing, StopsWhereThePointsEnd)
{
	const CreasePoints points = test::circularCrease(0.5, spacing, 0.0, 0.5);
	CreaseTracing      tracing(points);
	const auto         traces = tracing.traceAll(step, 0.5);
	ASSERT_EQ(traces.size(), 1u);
	EXPECT_FALSE(traces[0].closed);
	for (const CreasePoint& v : traces[0].vertices)
		EXPECT_GT(v.position.y(), -2.0 * spacing);
}

TEST(CreaseTracing, WidthGrowsWithSpacingAndNoise)
{
	CreasePoints      points = test::circularCrease(0.5, spacing);
	const CreasePoint at     = points.points[0];
	const double      exact  = CreaseTracing(points).width(at);
	CreasePoint       sparse = at;
	sparse.spacing *= 2.0;
	EXPECT_DOUBLE_EQ(CreaseTracing(points).width(sparse), 2.0 * exact);
	points.faceDeviation = spacing;
	EXPECT_GT(CreaseTracing(points).width(at), exact);
	EXPECT_EQ(CreaseTracing(points).faceDeviation(), spacing);
}

TEST(CreasePoint, ReversedTwiceIsItself)
{
	const CreasePoint p = test::circularCrease(0.5, spacing).points[0], back = p.reversed();
	EXPECT_EQ(back.tangent, -p.tangent);
	EXPECT_EQ(back.left, p.right);
	EXPECT_EQ(back.right, p.left);
	EXPECT_NE(back.fromLeft, p.fromLeft);
	EXPECT_EQ(back.angle, p.angle);
	// convex stays convex
	EXPECT_GT(back.tangent.dot(back.left.cross(back.right)) * back.angle, 0.0);
	EXPECT_EQ(back.reversed().tangent, p.tangent);
	EXPECT_EQ(back.reversed().fromLeft, p.fromLeft);
}

} // namespace
} // namespace curvature_lines
