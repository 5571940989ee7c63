// Crossings of lines: brute force in the plane, counts on torus and sphere, joints, touches and
// sheets. SPDX-License-Identifier: GPL-3.0-or-later
#include "line_intersections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "line_crossing.h"
#include "line_network.h"
#include "line_networks.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using namespace tests;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

PointCloud planeCloud(Index n, std::uint64_t seed)
{
	samples::Random random(seed, 1);
	PointCloud      cloud{Matrix3Xd(3, n), Matrix3Xd(3, n)};
	cloud.normals.colwise() = Vector3d::UnitZ();
	for (Index i = 0; i < n; ++i)
		cloud.positions.col(i) = Vector3d(random.uniform(), random.uniform(), 0.0);
	return cloud;
}

// Straight lines across the unit square, each cut into pieces of random length.
LineNetwork randomSegments(Index count, std::uint64_t seed)
{
	samples::Random random(seed, 2);
	NetworkBuilder  builder(planeNormal());
	for (Index i = 0; i < count; ++i) {
		const Vector3d a(random.uniform(), random.uniform(), 0.0),
			b(random.uniform(), random.uniform(), 0.0);
		const double bow = random.uniform(0.5, 2.0); // uneven steps along the same segment
		builder.add(1 + i % 2, false, 3 + static_cast<int>(random.index(60)), [&](double t) {
			return Vector3d(a + std::pow(t, bow) * (b - a));
		});
	}
	return builder.lines();
}

double cross(const Vector3d& a, const Vector3d& b)
{
	return a.x() * b.y() - a.y() * b.x();
}

struct PlanarCrossing {
	Vector3d position;
	int      side;
};

std::map<std::pair<Index, Index>, std::vector<PlanarCrossing>>
byBruteForce(const LineNetwork& lines)
{
	std::map<std::pair<Index, Index>, std::vector<PlanarCrossing>> found;
	for (Index a = 0; a < lines.lines(); ++a) {
		for (Index b = a + 1; b < lines.lines(); ++b) {
			for (Index i = lines.offsets[a]; i + 1 < lines.offsets[a + 1]; ++i) {
				for (Index j = lines.offsets[b]; j + 1 < lines.offsets[b + 1]; ++j) {
					const Vector3d p = lines.vertices.col(i), d = lines.vertices.col(i + 1) - p;
					const Vector3d q = lines.vertices.col(j), e = lines.vertices.col(j + 1) - q;
					const double   det = cross(d, e);
					const double   s = cross(q - p, e) / det, t = cross(q - p, d) / det;
					if (s >= 0.0 && s < 1.0 && t >= 0.0 && t < 1.0)
						found[{a, b}].push_back({p + s * d, det > 0.0 ? 1 : -1});
				}
			}
		}
	}
	return found;
}

void expectSorted(const LineIntersections& found, const LineNetwork& lines)
{
	std::vector<Index> seen;
	for (Index line = 0; line < lines.lines(); ++line) {
		double last = -1.0;
		for (const Index entry : found.alongLine[line]) {
			const LineCrossing& c = found.crossings[entry >> 1];
			EXPECT_EQ(c.line[entry & 1], line);
			EXPECT_GE(c.parameter[entry & 1], last);
			EXPECT_LT(c.parameter[entry & 1], segmentCount(lines, line));
			last = c.parameter[entry & 1];
			seen.push_back(entry);
		}
	}
	std::sort(seen.begin(), seen.end());
	ASSERT_EQ(seen.size(), 2 * found.crossings.size());
	for (Index k = 0; k < static_cast<Index>(seen.size()); ++k)
		EXPECT_EQ(seen[k], k);
}

TEST(LineIntersections, PlanarArrangementsMatchBruteForce)
{
	for (std::uint64_t seed = 1; seed <= 10; ++seed) {
		const PointCloud        cloud = planeCloud(400, seed);
		const LineNetwork       lines = randomSegments(40, seed);
		const LineIntersections found = intersectLines(VoronoiCells(cloud.positions), lines);
		auto                    exact = byBruteForce(lines);
		expectSorted(found, lines);
		std::size_t expected = 0;
		for (const auto& [pair, list] : exact)
			expected += list.size();
		EXPECT_EQ(found.crossings.size(), expected);
		for (const LineCrossing& c : found.crossings) {
			const auto& list = exact[{c.line[0], c.line[1]}];
			ASSERT_EQ(list.size(), 1u);
			EXPECT_LT((c.position - list[0].position).norm(), 1e-9);
			EXPECT_EQ(c.side, list[0].side);
			for (const int slot : {0, 1})
				EXPECT_LT(
					(pointOnLine(lines, c.line[slot], c.parameter[slot]) - c.position).norm(),
					1e-9);
		}
	}
}

TEST(LineIntersections, RigidMotionFlippedNormalsAndThreadsChangeNothing)
{
	const PointCloud  cloud = planeCloud(400, 4);
	const LineNetwork lines = randomSegments(40, 4);
	const auto        still = intersectLines(VoronoiCells(cloud.positions), lines);

	const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
	LineNetwork    moved  = lines;
	moved.vertices        = (turn * lines.vertices).colwise() + Vector3d(0.1, -0.2, 0.3);
	moved.normals         = -(turn * lines.normals);
	const Matrix3Xd sites = (turn * cloud.positions).colwise() + Vector3d(0.1, -0.2, 0.3);
	const auto      other = intersectLines(VoronoiCells(sites), moved);
	ASSERT_EQ(other.crossings.size(), still.crossings.size());
	for (std::size_t c = 0; c < still.crossings.size(); ++c) {
		EXPECT_NEAR(other.crossings[c].parameter[0], still.crossings[c].parameter[0], 1e-9);
		EXPECT_EQ(other.crossings[c].side, -still.crossings[c].side);
	}

	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto alone = intersectLines(VoronoiCells(cloud.positions), lines);
	omp_set_num_threads(threads);
	ASSERT_EQ(alone.crossings.size(), still.crossings.size());
	for (std::size_t c = 0; c < still.crossings.size(); ++c)
		EXPECT_EQ(alone.crossings[c].position, still.crossings[c].position);
}

// Lines through each other's vertices: every coincidence a predicate can meet, on a grid of exact
// numbers.
TEST(LineIntersections, LinesThatMeetAtCommonVerticesCrossOnce)
{
	const PointCloud cloud = planeCloud(400, 1);
	NetworkBuilder   builder(planeNormal());
	const Index      n = 8;
	for (Index i = 1; i <= n; ++i) {
		const double x = i / 16.0;
		builder.addSegment(1, {x, 0, 0}, {x, 1, 0}, 16);
		builder.addSegment(2, {1, x, 0}, {0, x, 0}, 16);
	}
	const LineNetwork       lines = builder.lines();
	const LineIntersections found = intersectLines(VoronoiCells(cloud.positions), lines);
	ASSERT_EQ(found.crossings.size(), static_cast<std::size_t>(n * n));
	EXPECT_EQ(found.dangling, 4 * n);
	for (const std::vector<Index>& entries : found.alongLine)
		EXPECT_EQ(entries.size(), static_cast<std::size_t>(n));
}

TEST(LineIntersections, TorusCirclesCrossOncePerPair)
{
	for (std::uint64_t seed = 1; seed <= 6; ++seed) {
		const PointCloud  cloud   = sampleCloud("torus", 2000, seed);
		const double      spacing = 0.09;
		const LineNetwork lines   = torusNetwork(30, 14, 60, 0.1 * spacing, seed);
		const auto        found   = intersectLines(VoronoiCells(cloud.positions), lines);
		ASSERT_EQ(found.crossings.size(), 30u * 14u);
		EXPECT_EQ(found.dangling, 0);
		for (const LineCrossing& c : found.crossings) {
			EXPECT_NE(lines.family[c.line[0]], lines.family[c.line[1]]);
			EXPECT_EQ(c.side, found.crossings[0].side);
			EXPECT_GT(c.side * c.normal.dot(c.tangent[0].cross(c.tangent[1])), 0.0);
			EXPECT_LT(
				(c.position - samples::surface("torus").project(c.position)).norm(), 0.5 * spacing);
		}
	}
}

TEST(LineIntersections, GreatCirclesCrossTwicePerPair)
{
	for (std::uint64_t seed = 1; seed <= 6; ++seed) {
		const PointCloud  cloud = sampleCloud("sphere", 2000, seed);
		const LineNetwork lines = greatCircles(14, 200, 0.0, seed);
		const auto        found = intersectLines(VoronoiCells(cloud.positions), lines);
		std::map<std::pair<Index, Index>, int> count, sides;
		for (const LineCrossing& c : found.crossings) {
			++count[{c.line[0], c.line[1]}];
			sides[{c.line[0], c.line[1]}] += c.side;
		}
		EXPECT_EQ(count.size(), 14u * 13u / 2u);
		for (const auto& [pair, n] : count) {
			EXPECT_EQ(n, 2);
			EXPECT_EQ((sides[pair]), 0);
		}
	}
}

TEST(LineIntersections, TouchesAndCurlsAreNoCrossings)
{
	const PointCloud   cloud = planeCloud(400, 1); // spacing about 0.04
	const VoronoiCells cells(cloud.positions);
	const auto         bump = [](double height) {
        return [height](double t) {
            return Vector3d(
                t, 0.5 + height * (std::exp(-std::pow((t - 0.5) / 0.05, 2)) - 0.5), 0.0);
        };
	};
	const auto crossingsWith = [&](const NetworkBuilder::Curve& curve) {
		NetworkBuilder builder(planeNormal());
		builder.addSegment(1, {0.01, 0.501, 0}, {0.99, 0.499, 0}, 50);
		return intersectLines(cells, builder.add(2, false, 200, curve).lines());
	};
	const LineIntersections touch = crossingsWith(bump(0.01));
	EXPECT_EQ(touch.crossings.size(), 0u);
	EXPECT_EQ(touch.cancelled, 2);
	// A detour over many spacings is no touch.
	EXPECT_EQ(
		crossingsWith([](double t) {
			return Vector3d(t, 0.7 - 1.6 * t * (1.0 - t), 0.0);
		}).crossings.size(),
		2u);
	// A curl on the way through: crosses the line once, itself never.
	const LineIntersections curl = crossingsWith([](double t) {
		const double a = 2 * Pi * std::clamp((t - 0.4) / 0.2, 0.0, 1.0);
		return Vector3d(0.3 + 0.02 * std::sin(a), t + 0.1 * std::sin(a), 0.0);
	});
	ASSERT_EQ(curl.crossings.size(), 1u);
	EXPECT_NE(curl.crossings[0].line[0], curl.crossings[0].line[1]);
}

TEST(LineIntersections, SheetsBackToBackDoNotMeet)
{
	const PointCloud   cloud = planeCloud(400, 1);
	const VoronoiCells cells(cloud.positions);
	const double       gap    = 0.01; // a quarter of the spacing, well inside a strip
	const auto         facing = [&](double sign) {
        NetworkBuilder builder(
            [&](const Vector3d& p) { return Vector3d(0, 0, p.z() > 0.0 ? 1.0 : sign); });
        builder.addSegment(1, {0.1, 0.5, gap}, {0.9, 0.5, gap}, 40);
        builder.addSegment(2, {0.5, 0.1, 0}, {0.5, 0.9, 0}, 40);
        return intersectLines(cells, builder.lines()).crossings.size();
	};
	EXPECT_EQ(facing(1.0), 1u);
	EXPECT_EQ(facing(-1.0), 0u);
}

TEST(LineIntersections, DegenerateLinesAreHarmless)
{
	const PointCloud   cloud = planeCloud(30, 1);
	const VoronoiCells cells(cloud.positions);
	EXPECT_TRUE(intersectLines(cells, LineNetwork()).crossings.empty());
	NetworkBuilder builder(planeNormal());
	builder.add(1, false, 0, [](double) { return Vector3d(0.5, 0.5, 0); }); // one vertex
	builder.add(1, true, 2, [](double t) { return Vector3d(t, 0.5, 0); });  // "closed" pair
	builder.add(2, true, 5, [](double) { return Vector3d(0.5, 0.5, 0); });  // no extent
	builder.addSegment(2, {0.25, 0.1, 0}, {0.25, 0.9, 0}, 1);
	const LineIntersections found = intersectLines(cells, builder.lines());
	EXPECT_EQ(found.crossings.size(), 1u);
	EXPECT_TRUE(found.crossings[0].position.allFinite());
}

} // namespace
} // namespace curvature_lines
