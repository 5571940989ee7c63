// Wrong orders of crossings on three lines are found and mended, right ones left alone.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossing_order.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "line_crossing.h"
#include "line_intersections.h"
#include "line_network.h"
#include "line_networks.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using namespace tests;
using Eigen::Vector3d;

// Three lines around a triangle of sides about `size`, and the exact crossings.
struct ThreeLines {
	LineNetwork               lines;
	std::vector<LineCrossing> crossings;

	explicit ThreeLines(double size, double turn)
	{
		NetworkBuilder builder(planeNormal());
		for (int i = 0; i < 3; ++i) {
			const double   a = turn + 2 * Pi * i / 3;
			const Vector3d along(std::cos(a), std::sin(a), 0.0), foot(-along.y(), along.x(), 0.0);
			const Vector3d middle = Vector3d(0.5, 0.5, 0.0) + 0.29 * size * foot;
			// Directions that do not follow the triangle round make other sides and orders.
			const double sense = i == 1 ? -1.0 : 1.0;
			builder.addSegment(1, middle - 0.4 * sense * along, middle + 0.4 * sense * along, 41);
		}
		lines = builder.lines();
		PointCloud      cloud{Eigen::Matrix3Xd(3, 400), {}};
		samples::Random random(1, 1);
		for (Index i = 0; i < 400; ++i)
			cloud.positions.col(i) = Vector3d(random.uniform(), random.uniform(), 0.0);
		crossings = intersectLines(VoronoiCells(cloud.positions), lines).crossings;
	}
	std::vector<double> reach(double length) const
	{
		return std::vector<double>(lines.vertices.cols(), length);
	}
};

TEST(CrossingOrder, OneWrongOrderIsMended)
{
	for (int k = 0; k < 12; ++k) {
		const ThreeLines exact(0.02, 0.5 * k);
		ASSERT_EQ(exact.crossings.size(), 3u);
		auto right = exact.crossings;
		EXPECT_EQ(makeConsistent(exact.lines, exact.reach(0.1), right), 0);

		const auto along = sortAlongLines(exact.lines, exact.crossings);
		for (Index line = 0; line < 3; ++line) {
			auto        wrong = exact.crossings;
			const Index a = along[line][0], b = along[line][1];
			std::swap(wrong[a >> 1].parameter[a & 1], wrong[b >> 1].parameter[b & 1]);
			EXPECT_EQ(makeConsistent(exact.lines, exact.reach(0.1), wrong), 1);
			EXPECT_EQ(sortAlongLines(exact.lines, wrong), along);
		}
	}
}

TEST(CrossingOrder, LargeTrianglesAreNotTouched)
{
	const ThreeLines exact(0.3, 0.4);
	auto             wrong = exact.crossings;
	const auto       along = sortAlongLines(exact.lines, exact.crossings);
	const Index      a = along[0][0], b = along[0][1];
	std::swap(wrong[a >> 1].parameter[a & 1], wrong[b >> 1].parameter[b & 1]);
	EXPECT_EQ(makeConsistent(exact.lines, exact.reach(0.1), wrong), 0);
	EXPECT_EQ(wrong.size(), 3u);
}

} // namespace
} // namespace curvature_lines
