// Sites of the scaffold: even and dense in the cloud, away from creases, and on them at even distances.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaffold_sites.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "point_subsets.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// Independent points of the unit square: shuffled as they are.
PointCloud square(Index points)
{
	samples::Random random(5, 0);
	PointCloud      cloud;
	cloud.positions.setZero(3, points);
	cloud.normals = Vector3d::UnitZ().replicate(1, points);
	for (Index i = 0; i < points; ++i)
		cloud.positions.col(i).head<2>() << random.uniform(), random.uniform();
	return cloud;
}

FeatureLine polyline(const std::vector<Vector3d>& corners, bool closed = false)
{
	FeatureLine line;
	line.points.resize(3, static_cast<Eigen::Index>(corners.size()));
	for (std::size_t k = 0; k < corners.size(); ++k)
		line.points.col(static_cast<Eigen::Index>(k)) = corners[k];
	line.closed = closed;
	return line;
}

Eigen::VectorXd constant(Index points, double value)
{
	return Eigen::VectorXd::Constant(points, value);
}

// Names that the points had before they were shuffled: any.
std::vector<Index> namesOf(Index points)
{
	std::vector<Index> names(points);
	std::iota(names.rbegin(), names.rend(), 100);
	return names;
}

Index fromCloud(const ScaffoldSites& sites)
{
	Index count = 0;
	while (count < static_cast<Index>(sites.source.size()) && sites.source[count] >= 0)
		++count;
	return count;
}

TEST(ScaffoldSites, AreEvenAndDense)
{
	const PointSample        sample(square(3000));
	const std::vector<Index> names    = namesOf(3000);
	const double             distance = 0.06;
	const ScaffoldSites      sites =
		chooseSites(sample, names, {}, constant(3000, distance), constant(3000, 0.01));
	ASSERT_EQ(fromCloud(sites), static_cast<Index>(sites.points.cols()));
	for (Eigen::Index a = 0; a < sites.points.cols(); ++a)
		for (Eigen::Index b = 0; b < a; ++b)
			EXPECT_GE((sites.points.col(a) - sites.points.col(b)).norm(), distance);
	for (Index i = 0; i < sample.cloud.size(); ++i)
		EXPECT_LE(
			(sites.points.colwise() - sample.cloud.positions.col(i)).colwise().norm().minCoeff(),
			distance);
	for (Eigen::Index a = 0; a < sites.points.cols(); ++a) {
		const Index i = 3099 - sites.source[a]; // names run backwards
		EXPECT_EQ(sites.points.col(a), sample.cloud.positions.col(i));
		EXPECT_EQ(sites.normals.col(a), sample.cloud.normals.col(i));
	}
	EXPECT_TRUE(sites.creaseEdges.empty());
}

TEST(ScaffoldSites, KeepClearOfCreases)
{
	const PointSample        sample(square(4000));
	const std::vector<Index> names     = namesOf(4000);
	const double             clearance = 0.05;
	const FeatureLine        crease = polyline({{0.1, 0.5, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.9, 0.0}});
	const ScaffoldSites      sites =
		chooseSites(sample, names, {crease}, constant(4000, 0.04), constant(4000, clearance));
	const Index first = fromCloud(sites), count = static_cast<Index>(sites.points.cols());
	// .8 of length in pieces of .93 clearances at most
	ASSERT_EQ(static_cast<Index>(sites.creaseEdges.size()), 18);
	ASSERT_EQ(count - first, 19);
	for (Index a = first; a < count; ++a) {
		EXPECT_EQ(sites.source[a], -1);
		EXPECT_EQ(sites.normals.col(a), Vector3d::Zero());
		const Vector3d p = sites.points.col(a);
		EXPECT_TRUE(std::abs(p.y() - 0.5) < 1e-12 || std::abs(p.x() - 0.5) < 1e-12);
		for (Index b = 0; b < first; ++b)
			EXPECT_GE((sites.points.col(b) - p).norm(), clearance);
	}
	for (const auto& [a, b] : sites.creaseEdges) {
		EXPECT_GE(a, first);
		EXPECT_GE(b, first);
		EXPECT_LE((sites.points.col(a) - sites.points.col(b)).norm(), 0.8 / 18 + 1e-12);
	}
}

TEST(ScaffoldSites, CreasesThatMeetShareASample)
{
	const PointSample        sample(square(100));
	const std::vector<Index> names = namesOf(100);
	const Vector3d           middle(0.5, 0.5, 0.0);
	std::vector<FeatureLine> star;
	for (int k = 0; k < 3; ++k) {
		const double angle = 2.0 * k;
		star.push_back(
			polyline({middle, middle + 0.3 * Vector3d(std::cos(angle), std::sin(angle), 0.0)}));
	}
	const ScaffoldSites sites =
		chooseSites(sample, names, star, constant(100, 0.1), constant(100, 0.1));
	const Index first = fromCloud(sites), count = static_cast<Index>(sites.points.cols());
	const Index edges = static_cast<Index>(sites.creaseEdges.size());
	EXPECT_EQ(count - first, edges + 1); // a tree
	Index atMiddle = 0;
	for (const auto& [a, b] : sites.creaseEdges)
		atMiddle += (sites.points.col(a) - middle).norm() < 1e-12 ||
		            (sites.points.col(b) - middle).norm() < 1e-12;
	EXPECT_EQ(atMiddle, 3);
}

TEST(ScaffoldSites, ClosedCreasesAreLoops)
{
	const PointSample        sample(square(100));
	const std::vector<Index> names = namesOf(100);
	const double             h     = 0.01; // shorter than one step
	for (const double size : {h, 0.6}) {
		const FeatureLine   loop = polyline({{0, 0, 1}, {size, 0, 1}, {0, size, 1}}, true);
		const ScaffoldSites sites =
			chooseSites(sample, names, {loop}, constant(100, 0.1), constant(100, 0.1));
		const Index first = fromCloud(sites), count = static_cast<Index>(sites.points.cols());
		EXPECT_GE(count - first, 3);
		ASSERT_EQ(count - first, static_cast<Index>(sites.creaseEdges.size()));
		std::multiset<Index> ends;
		for (const auto& [a, b] : sites.creaseEdges) {
			ends.insert(a);
			ends.insert(b);
		}
		for (Index a = first; a < count; ++a)
			EXPECT_EQ(ends.count(a), 2u);
	}
	// A line of one point is none.
	EXPECT_TRUE(chooseSites(
					sample,
					names,
					{polyline({{0, 0, 1}, {0, 0, 1}})},
					constant(100, 0.1),
					constant(100, 0.1))
	                .creaseEdges.empty());
}

// Fine to the left, coarse to the right.
TEST(ScaffoldSites, FollowADistanceThatChanges)
{
	const PointSample sample(square(6000));
	Eigen::VectorXd   distance(6000);
	for (Index i = 0; i < 6000; ++i)
		distance[i] = 0.02 + 0.08 * sample.cloud.positions(0, i);
	const ScaffoldSites sites =
		chooseSites(sample, namesOf(6000), {}, distance, constant(6000, 0.01));
	ASSERT_EQ(sites.distance.size(), sites.points.cols());
	for (Index a = 0; a < sites.size(); ++a) {
		EXPECT_EQ(sites.distance[a], 0.02 + 0.08 * sites.points(0, a));
		EXPECT_EQ(sample.cloud.positions.col(sites.place[a]), sites.points.col(a));
		for (Index b = 0; b < a; ++b)
			EXPECT_GE(
				(sites.points.col(a) - sites.points.col(b)).norm(),
				0.5 * (sites.distance[a] + sites.distance[b]) - 1e-12);
	}
	// Nowhere empty: every point has a site within the mean of both distances.
	for (Index i = 0; i < 6000; ++i) {
		const Eigen::VectorXd away =
			(sites.points.colwise() - sample.cloud.positions.col(i)).colwise().norm();
		const auto mean = 0.5 * (sites.distance.array() + distance[i]);
		EXPECT_LE((away.array() - mean).minCoeff(), 0.0);
	}
}

// A hundred points on the left half, five thousand on the right: the sites cannot be as near as wanted.
TEST(ScaffoldSites, KnowHowFarTheirNeighboursAre)
{
	PointCloud cloud = square(5100);
	cloud.positions.row(0) *= 0.5;
	cloud.positions.row(0).tail(5000).array() += 0.5;
	const PointSample   sample(cloud);
	const ScaffoldSites sites =
		chooseSites(sample, namesOf(5100), {}, constant(5100, 0.02), constant(5100, 0.01));
	double sparse = 0.0, dense = 0.0, left = 0.0, right = 0.0;
	for (Index a = 0; a < sites.size(); ++a) {
		EXPECT_GE(sites.around[a], sites.distance[a]);
		const double x = sites.points(0, a);
		if (x < 0.45) {
			sparse += sites.around[a];
			left += 1.0;
		}
		else if (x > 0.55) {
			dense += sites.around[a];
			right += 1.0;
		}
	}
	EXPECT_NEAR(dense / right, 0.02, 0.002);
	// One point in .005 of area: neighbours are .07 away, distances that lead to such .05.
	EXPECT_NEAR(sparse / left, 0.055, 0.015);
}

TEST(ScaffoldSites, CopiesAreKnownAsTheirOriginals)
{
	const PointSample sample(square(300));
	ScaffoldSites     sites = chooseSites(
        sample,
        namesOf(300),
        {polyline({{0.1, 0.5, 0.0}, {0.5, 0.5, 0.0}})},
        constant(300, 0.1),
        constant(300, 0.1));
	const ScaffoldSites      before = sites;
	const Index              count  = before.size();
	const std::vector<Index> which  = {3, 0, 3, count - 1};
	sites.appendCopies(which);
	sites.appendCopies({});
	sites.appendCopies({count + 1}); // a copy of a copy
	std::vector<Index> from(count);
	std::iota(from.begin(), from.end(), 0);
	from.insert(from.end(), which.begin(), which.end());
	from.push_back(0);
	ASSERT_EQ(sites.size(), static_cast<Index>(from.size()));
	ASSERT_EQ(sites.normals.cols(), sites.points.cols());
	ASSERT_EQ(sites.source.size(), from.size());
	ASSERT_EQ(sites.place.size(), from.size());
	ASSERT_EQ(sites.distance.size(), sites.points.cols());
	ASSERT_EQ(sites.around.size(), sites.points.cols());
	for (std::size_t a = 0; a < from.size(); ++a) {
		EXPECT_EQ(sites.points.col(a), before.points.col(from[a]));
		EXPECT_EQ(sites.normals.col(a), before.normals.col(from[a]));
		EXPECT_EQ(sites.source[a], before.source[from[a]]);
		EXPECT_EQ(sites.place[a], before.place[from[a]]);
		EXPECT_EQ(sites.distance[a], before.distance[from[a]]);
		EXPECT_EQ(sites.around[a], before.around[from[a]]);
	}
	EXPECT_EQ(sites.creaseEdges, before.creaseEdges);
}

// Pieces of creases are as long as the clearance where they are.
TEST(ScaffoldSites, CreasesAreSampledAsFinelyAsTheirPlaceAsks)
{
	const PointSample sample(square(4000));
	Eigen::VectorXd   clearance(4000);
	for (Index i = 0; i < 4000; ++i)
		clearance[i] = sample.cloud.positions(0, i) < 0.5 ? 0.02 : 0.08;
	std::vector<Vector3d> corners;
	for (int k = 0; k <= 100; ++k)
		corners.emplace_back(0.1 + 0.008 * k, 0.5, 0.0);
	const ScaffoldSites sites =
		chooseSites(sample, namesOf(4000), {polyline(corners)}, clearance, clearance);
	for (const auto& [a, b] : sites.creaseEdges) {
		const double length = (sites.points.col(a) - sites.points.col(b)).norm();
		const double x      = 0.5 * (sites.points(0, a) + sites.points(0, b));
		if (x < 0.45) {
			EXPECT_NEAR(length, 0.93 * 0.02, 0.002);
		}
		if (x > 0.58) {
			EXPECT_NEAR(length, 0.93 * 0.08, 0.008);
		}
	}
	// And points keep as far from them as their own place asks.
	const Index first = fromCloud(sites);
	Index       near  = 0;
	for (Index a = 0; a < first; ++a) {
		const double away =
			(sites.points.rightCols(sites.size() - first).colwise() - sites.points.col(a))
				.colwise()
				.norm()
				.minCoeff();
		EXPECT_GE(away, clearance[sites.place[a]]);
		near += away < 0.05;
	}
	EXPECT_GT(near, 20);
}

} // namespace
} // namespace curvature_lines::test
