// Regions against brute force: their points, coordinates in radii, pairs and the prior weights of these.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "irls.h"
#include "neighborhoods.h"
#include "operating_region.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Fixture {
	PointCloud      cloud;
	NeighborSearch  search;
	OperatingRegion region;

	explicit Fixture(const PointCloud& points) : cloud(points), search(cloud.positions) {}
	void collect(Index i, double spacing, Index minPoints = 6, Index maxPoints = 0)
	{
		region.collect(cloud, search, i, cloud.normals.col(i), spacing, 3.0, minPoints, maxPoints);
	}
};

PointCloud torus()
{
	samples::SampleRequest request;
	request.points    = 2000;
	request.seed      = 7;
	const auto sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

TEST(OperatingRegion, HoldsThePointsOfTheBallInItsRadii)
{
	Fixture f(torus());
	for (const Index i : {0, 17, 500}) {
		f.collect(i, 0.06);
		const OperatingRegion& region = f.region;
		EXPECT_NEAR(region.radius, 0.18, 1e-12);
		EXPECT_NEAR(region.spacing, 1.0 / 3.0, 1e-12);
		ASSERT_EQ(region.points[0], i);
		std::set<Index> expected;
		for (Index j = 0; j < f.cloud.size(); ++j)
			if ((f.cloud.positions.col(j) - f.cloud.positions.col(i)).norm() <= 0.18)
				expected.insert(j);
		EXPECT_GT(expected.size(), 8u);
		EXPECT_EQ(std::set<Index>(region.points.begin(), region.points.end()), expected);
		for (Index k = 0; k < region.size(); ++k) {
			const Index    j = region.points[k];
			const Vector3d d =
				region.frame.toSpace(region.positions[k]) + region.heights[k] * region.frame.n;
			EXPECT_LT(
				(f.cloud.positions.col(i) + region.radius * d - f.cloud.positions.col(j)).norm(),
				1e-12);
			EXPECT_NEAR(region.squaredDistances[k], d.squaredNorm(), 1e-12);
			const Vector3d n = region.normals[k];
			EXPECT_LT(
				(n.x() * region.frame.u + n.y() * region.frame.v + n.z() * region.frame.n -
			     f.cloud.normals.col(j))
					.norm(),
				1e-12);
		}
	}
}

TEST(OperatingRegion, GrowsWherePointsAreFewAndIsCutWhereTheyAreMany)
{
	Fixture f(torus());
	f.collect(3, 0.02, 8); // hardly a point within 0.06
	EXPECT_GT(f.region.size(), 1);
	EXPECT_LE(f.region.size(), 9);
	EXPECT_LE(f.region.radius, 0.12 + 1e-12);
	EXPECT_GE(f.region.radius, 0.06);
	f.collect(3, 0.1, 6, 20);
	EXPECT_EQ(f.region.size(), 21);
	const auto nearest = f.search.nearest(f.cloud.positions.col(3), 21);
	EXPECT_EQ(
		std::set<Index>(f.region.points.begin(), f.region.points.end()),
		std::set<Index>(nearest.begin(), nearest.end()));
	EXPECT_NEAR(
		f.region.radius,
		(f.cloud.positions.col(nearest.back()) - f.cloud.positions.col(3)).norm(),
		1e-12);
}

TEST(OperatingRegion, PairsAreAllPairsOrAFixedShareOfThem)
{
	Fixture f(torus());
	f.collect(9, 0.08);
	const Index        n = f.region.size();
	std::vector<Index> members(n);
	for (Index k = 0; k < n; ++k)
		members[k] = k;
	VariationSamples samples, again;
	collectCentrePairs(f.region, samples);
	EXPECT_EQ(samples.size(), n - 1);
	for (Index s = 0; s < samples.size(); ++s) {
		EXPECT_EQ(samples.first[s], 0);
		EXPECT_EQ(samples.second[s], s + 1);
	}
	collectPairs(f.region, members, 1000000, samples);
	ASSERT_EQ(samples.size(), n * (n - 1) / 2);
	for (Index s = 0; s < samples.size(); ++s) {
		const Index a = samples.first[s], b = samples.second[s];
		EXPECT_LT(a, b);
		EXPECT_EQ(samples.pu[s], f.region.positions[b].x() - f.region.positions[a].x());
		EXPECT_EQ(samples.nw[s], f.region.normals[b].z() - f.region.normals[a].z());
		EXPECT_EQ(samples.geometric[s], f.region.geometricWeight(a, b));
		EXPECT_NEAR(
			samples.geometric[s],
			2.0 / (f.region.squaredDistances[a] + f.region.squaredDistances[b]),
			1e-6 * samples.geometric[s]);
	}
	const Index most = n * (n - 1) / 6;
	collectPairs(f.region, members, most, samples);
	collectPairs(f.region, members, most, again);
	EXPECT_NEAR(samples.size(), most, 4.0 * std::sqrt(double(most)));
	EXPECT_EQ(samples.first, again.first);
	EXPECT_EQ(samples.second, again.second);
}

TEST(OperatingRegion, NearlyCoincidentPointsHaveAFiniteWeight)
{
	PointCloud cloud       = torus();
	cloud.positions.col(1) = cloud.positions.col(0) + Vector3d(1e-14, 0, 0);
	Fixture f(cloud);
	f.collect(0, 0.06);
	EXPECT_TRUE(std::isfinite(f.region.geometricWeight(0, 1)));
	EXPECT_GT(f.region.geometricWeight(0, 1), f.region.geometricWeight(0, f.region.size() - 1));
}

} // namespace
} // namespace curvature_lines
