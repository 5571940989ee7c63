// Ends of traces, and gaps that are joined or are not.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "crease_ends.h"
#include "crease_points.h"
#include "crease_tracing.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.03, step = 0.7 * spacing;

// Vertices `step` apart from a to b; convex, faces to +y and +z where it runs along x.
CreaseTrace straight(const Vector3d& a, const Vector3d& b)
{
	CreaseTrace    trace;
	const Vector3d along = (b - a).normalized();
	const int      count = static_cast<int>((b - a).norm() / step);
	for (int k = 0; k <= count; ++k) {
		CreasePoint p;
		p.position = a + k * step * along;
		p.tangent  = along;
		p.left     = Vector3d::UnitZ().cross(along);
		p.right    = Vector3d::UnitZ();
		p.angle    = EIGEN_PI / 2.0;
		p.weight   = 1.0;
		p.spacing  = spacing;
		trace.vertices.push_back(p);
	}
	return trace;
}

CreaseTrace reversed(CreaseTrace trace)
{
	std::reverse(trace.vertices.begin(), trace.vertices.end());
	for (CreasePoint& v : trace.vertices)
		v = v.reversed();
	return trace;
}

TEST(CreaseEnds, LookOutward)
{
	std::vector<CreaseTrace> traces = {
		straight({0, 0, 0}, {1, 0, 0}), straight({0, 1, 0}, {1, 1, 0})};
	traces[1].closed = true; // has none
	const auto ends  = endsOf(traces);
	ASSERT_EQ(ends.size(), 2u);
	EXPECT_FALSE(ends[0].atBack);
	EXPECT_TRUE(ends[1].atBack);
	EXPECT_LT((ends[0].vertex.tangent + Vector3d::UnitX()).norm(), 1e-12);
	EXPECT_LT((ends[1].vertex.tangent - Vector3d::UnitX()).norm(), 1e-12);
	EXPECT_EQ(positionsOf(ends).col(1), traces[0].vertices.back().position);
	EXPECT_NEAR(lengthInSpacings(traces[0]), 1.0 / spacing, 1.0);
	EXPECT_GT(reachOf(ends[0].vertex, 0.01), reachOf(ends[0].vertex, 0.0));
}

TEST(CreaseEnds, GapsAreJoinedWhicheverWayTheTracesRun)
{
	const CreasePoints  none;
	const CreaseTracing tracing(none);
	for (const bool turnFirst : {false, true})
		for (const bool turnSecond : {false, true}) {
			CreaseTrace a = straight({0, 0, 0}, {0.5, 0, 0}), b = straight({0.57, 0, 0}, {1, 0, 0});
			std::vector<CreaseTrace> traces = {
				turnFirst ? reversed(a) : a, turnSecond ? reversed(b) : b};
			joinGaps(tracing, step, traces);
			ASSERT_EQ(traces.size(), 1u);
			EXPECT_FALSE(traces[0].closed);
			EXPECT_EQ(traces[0].vertices.size(), a.vertices.size() + b.vertices.size());
			const double way =
				traces[0].vertices.back().position.x() - traces[0].vertices.front().position.x();
			EXPECT_NEAR(std::abs(way), 1.0, step);
			for (std::size_t v = 1; v < traces[0].vertices.size(); ++v) {
				const Vector3d d =
					traces[0].vertices[v].position - traces[0].vertices[v - 1].position;
				EXPECT_GT(d.dot(traces[0].vertices[v - 1].tangent), 0.0);
			}
		}
}

TEST(CreaseEnds, WideGapsBendsAndOtherCreasesStayApart)
{
	const CreasePoints  none;
	const CreaseTracing tracing(none);
	const CreaseTrace   first   = straight({0, 0, 0}, {0.5, 0, 0});
	CreaseTrace         concave = straight({0.55, 0, 0}, {1, 0, 0});
	for (CreasePoint& v : concave.vertices)
		v.angle = -v.angle;
	for (const CreaseTrace& other :
	     {straight({0.8, 0, 0}, {1.2, 0, 0}),
	      straight({0.5, 0.05, 0}, {0.5, 0.5, 0}),
	      straight({0.55, 0.06, 0}, {1, 0.06, 0}),
	      concave}) {
		std::vector<CreaseTrace> traces = {first, other};
		joinGaps(tracing, step, traces);
		EXPECT_EQ(traces.size(), 2u);
	}
}

TEST(CreaseEnds, ARingWithAGapCloses)
{
	const CreasePoints  none;
	const CreaseTracing tracing(none);
	CreaseTrace         ring;
	for (double angle = 0.0; angle < 2.0 * EIGEN_PI - 0.1; angle += step / 0.5) {
		const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
		CreasePoint    p;
		p.position = 0.5 * out;
		p.tangent  = Vector3d::UnitZ().cross(out);
		p.left     = Vector3d::UnitZ();
		p.right    = out;
		p.angle    = EIGEN_PI / 2.0;
		p.spacing  = spacing;
		ring.vertices.push_back(p);
	}
	std::vector<CreaseTrace> traces = {ring};
	joinGaps(tracing, step, traces);
	ASSERT_EQ(traces.size(), 1u);
	EXPECT_TRUE(traces[0].closed);
}

TEST(CreaseEnds, NothingToJoin)
{
	const CreasePoints       none;
	std::vector<CreaseTrace> traces;
	joinGaps(CreaseTracing(none), step, traces);
	EXPECT_TRUE(traces.empty());
}

} // namespace
} // namespace curvature_lines
