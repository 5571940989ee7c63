// Proximity queries against brute force, and the bookkeeping of registered segments.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_registry.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "exact_field.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

class LineRegistryTest : public testing::Test {
protected:
	test::ExactCloud exact     = test::exactCloud({"torus", 1500});
	double           h         = exact.minimum.medianSpacing;
	NeighborLists    proximity = proximityGraph(exact.minimum);
	LineRegistry     registry{exact.cloud, exact.minimum, proximity};

	// A straight piece of half a spacing along d1 or d2, starting at a cloud point.
	FlowSegment segmentAt(Index i, int family, Index line, double arc) const
	{
		const auto&    d  = family == 1 ? exact.field.d1 : exact.field.d2;
		const Vector3d a  = exact.cloud.positions.col(i);
		const Vector3d b  = a + 0.5 * h * d.col(i);
		Index          to = 0;
		(exact.cloud.positions.colwise() - b).colwise().squaredNorm().minCoeff(&to);
		return {a, b, exact.cloud.normals.col(i), i, to, line, arc};
	}
	ProximityQuery queryAt(Index i, double radius) const
	{
		ProximityQuery query;
		query.position = exact.cloud.positions.col(i);
		query.normal   = exact.cloud.normals.col(i);
		query.cell     = i;
		query.radius   = radius;
		return query;
	}
};

double distance(const Vector3d& x, const FlowSegment& s)
{
	double nearest = HUGE_VAL;
	for (int k = 0; k <= 1000; ++k)
		nearest = std::min(nearest, (s.from + 0.001 * k * (s.to - s.from) - x).norm());
	return nearest;
}

TEST_F(LineRegistryTest, OccupiedWhereASegmentIsWithinTheRadius)
{
	std::vector<FlowSegment> segments;
	for (Index i = 0; i < exact.cloud.size(); i += 97)
		segments.push_back(segmentAt(i, 1, i, 0.0));
	for (const FlowSegment& s : segments)
		registry.add(s);
	int occupied = 0;
	for (Index i = 0; i < exact.cloud.size(); i += 3)
		for (const double radius : {0.5 * h, 2.0 * h, 5.0 * h}) {
			const ProximityQuery query   = queryAt(i, radius);
			double               nearest = HUGE_VAL;
			for (const FlowSegment& s : segments)
				if (s.normal.dot(query.normal) > 0.5)
					nearest = std::min(nearest, distance(query.position, s));
			if (std::abs(nearest - radius) < 1e-3 * h)
				continue; // the oracle is sampled
			EXPECT_EQ(registry.occupied(query), nearest < radius);
			occupied += nearest < radius;
		}
	EXPECT_GT(occupied, 100);
}

TEST_F(LineRegistryTest, OwnSegmentsCountOnlyInTheirArcsAndRadius)
{
	registry.add(segmentAt(10, 1, 7, 2.0));
	ProximityQuery query = queryAt(10, 3.0 * h);
	EXPECT_TRUE(registry.occupied(query));
	query.line      = 7;
	query.ownRadius = h;
	query.ownFrom   = 2.5;
	query.ownTo     = 9.0;
	EXPECT_FALSE(registry.occupied(query));
	query.ownFrom = 1.5;
	EXPECT_TRUE(registry.occupied(query));
	query.ownRadius = 0.0;
	EXPECT_FALSE(registry.occupied(query));
}

TEST_F(LineRegistryTest, SheetsDoNotSeeEachOther)
{
	registry.add(segmentAt(10, 1, 0, 0.0));
	ProximityQuery query = queryAt(10, 3.0 * h);
	query.normal         = -query.normal;
	EXPECT_FALSE(registry.occupied(query));
}

TEST_F(LineRegistryTest, TruncateTakesBack)
{
	registry.add(segmentAt(10, 1, 0, 0.0));
	const Index kept = registry.size();
	for (Index i = 0; i < 200; ++i)
		registry.add(segmentAt(i, 1, 1, 0.0));
	registry.truncate(kept);
	EXPECT_EQ(registry.size(), kept);
	EXPECT_TRUE(registry.occupied(queryAt(10, 0.1 * h)));
	for (Index i = 0; i < exact.cloud.size(); ++i)
		if ((exact.cloud.positions.col(i) - exact.cloud.positions.col(10)).norm() > 2.0 * h) {
			EXPECT_FALSE(registry.occupied(queryAt(i, h)));
		}
	registry.truncate(0);
	EXPECT_FALSE(registry.occupied(queryAt(10, 5.0 * h)));
}

TEST_F(LineRegistryTest, CountsEachCrossingOnce)
{
	LineRegistry other{exact.cloud, exact.minimum, proximity};
	// Two segments through the middle between two points: both registered with the same two cells.
	for (Index i = 0; i < exact.cloud.size(); i += 151) {
		const FlowSegment along  = segmentAt(i, 1, 0, 0.0);
		const Vector3d    middle = 0.5 * (along.from + along.to);
		const Vector3d    across = 0.2 * h * exact.field.d2.col(i);
		const Index       before = registry.countCrossings(other, exact.cloud.normals);
		registry.add(along);
		other.add(
			{middle - across, middle + across, along.normal, along.fromCell, along.toCell, 1, 0.0});
		EXPECT_EQ(registry.countCrossings(other, exact.cloud.normals), before + 1);
	}
}

} // namespace
} // namespace curvature_lines
