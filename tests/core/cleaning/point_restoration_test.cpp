// Thin parts of exact solids keep their points, and outliers beside them stay rejected.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_restoration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "outlier_ballot.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "rejected_points.h"
#include "thin_shapes.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Index countOf(const std::vector<char>& rejected, Index first, Index end)
{
	return static_cast<Index>(
		std::count(rejected.begin() + first, rejected.begin() + end, char(1)));
}

// Before single points were judged again, 25 to 40 points of the cone and 20 of the rod were lost.
TEST(PointRestoration, TipsAndRodsStay)
{
	for (const int seed : {1, 2, 3}) {
		SCOPED_TRACE(seed);
		EXPECT_LE(
			countOf(
				rejectedOf(sampledRevolution(sphereWithCone(0.25, 1.0), 10000, seed)), 0, 10000),
			4);
		EXPECT_LE(
			countOf(rejectedOf(sampledRevolution(sphereWithRod(0.05, 1.0), 10000, seed)), 0, 10000),
			4);
	}
}

// Its radius is .85 spacings and its foot a corner that no small surface follows: it comes back as a part of its own.
TEST(PointRestoration, ARodThinnerThanTheSpacingStays)
{
	EXPECT_LE(
		countOf(rejectedOf(sampledRevolution(sphereWithRod(0.03, 1.0), 10000, 2)), 0, 10000), 10);
}

// Their feet touch the surface at a point or two. A third of the seeds lost the whole rod.
TEST(PointRestoration, RodsOfHalfASpacingStay)
{
	for (const double radius : {0.018, 0.025, 0.03})
		for (const int seed : {1, 2, 3, 4}) {
			SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(seed));
			EXPECT_LE(
				countOf(
					rejectedOf(sampledRevolution(sphereWithRod(radius, 1.0), 10000, seed)),
					0,
					10000),
				10);
		}
}

// Half the points of a strip on the surface are rejected by hand.
TEST(PointRestoration, ContinuesASurfacePassByPass)
{
	samples::Random random(8, 0);
	Matrix3Xd       positions(3, 2500);
	for (auto p : positions.colwise()) {
		const double x = random.uniform(0.0, 1.0), y = random.uniform(0.0, 1.0);
		p << x, y, 0.1 * x * x;
	}
	const NeighborSearch search(positions);
	std::vector<double>  crowding(2500);
	std::vector<Index>   rank(2500);
	std::vector<char>    rejected(2500, 0);
	std::vector<Verdict> verdicts(2500);
	for (Index i = 0; i < 2500; ++i) {
		const Vector3d p    = positions.col(i);
		crowding[i]         = (positions.col(search.nearest(p, crowdSize + 1).back()) - p).norm();
		rank[i]             = i;
		rejected[i]         = p.x() > 0.7;
		verdicts[i].spacing = 0.02;
		verdicts[i].heightError = 0.001;
	}
	restorePoints({positions, crowding, rank, search, {}, search}, verdicts, 0.001, 3.5, rejected);
	EXPECT_EQ(countOf(rejected, 0, 2500), 0);
}

// Small surfaces through neighbours half of which are displaced pass through many a displaced point by chance.
TEST(PointRestoration, ImpulsesOnHalfThePointsStayRejected)
{
	for (const auto& [surface, found] :
	     std::map<std::string, double>{{"cube", 0.9}, {"torus", 0.83}}) {
		SCOPED_TRACE(surface);
		samples::SampleRequest request;
		request.surface           = surface;
		request.points            = 6000;
		request.seed              = 3;
		const auto        sample  = samples::generate(request);
		const double      spacing = std::sqrt((surface == "cube" ? 6.0 : 15.8) / 6000.0);
		samples::Random   random(10, 0);
		Matrix3Xd         positions = sample.positions;
		std::vector<char> displaced(6000, 0);
		for (Index i = 0; i < 6000; ++i)
			if (random.uniform(0.0, 1.0) < 0.5) {
				const double height = 0.8 * spacing * random.normal();
				displaced[i]        = std::abs(height) > 0.5 * spacing;
				positions.col(i) += height * sample.normals.col(i);
			}
		const std::vector<char> rejected = rejectedOf(positions);
		double                  all = 0.0, hit = 0.0;
		for (Index i = 0; i < 6000; ++i) {
			all += displaced[i];
			hit += displaced[i] && rejected[i];
		}
		EXPECT_GE(hit, found * all);
	}
}

TEST(PointRestoration, PatchesAndBlobsBesideAConeStayRejected)
{
	const int       n       = 10000;
	const double    spacing = 0.036;
	const Matrix3Xd solid   = sampledRevolution(sphereWithCone(0.25, 1.0), n, 5);
	samples::Random random(9, 0);
	Matrix3Xd       positions(3, n + 12 * 20 + 25 * 10);
	positions.leftCols(n) = solid;
	Index      next       = n;
	const auto beside     = [&](double height) -> Vector3d { // over the sphere
        Vector3d outward = random.normal3().normalized();
        outward.z()      = -std::abs(outward.z());
        return (1.0 + height * spacing) * outward;
	};
	for (int blob = 0; blob < 20; ++blob) {
		const Vector3d middle = beside(random.uniform(3.0, 6.0));
		for (int k = 0; k < 12; ++k)
			positions.col(next++) = middle + 0.7 * spacing * random.normal3();
	}
	for (int patch = 0; patch < 10; ++patch) {
		const double height = 1.0 + spacing * random.uniform(2.0, 5.0);
		const double around = 0.6 * patch, up = random.uniform(-0.8, 0.3);
		for (int k = 0; k < 25; ++k) {
			const double a = around + spacing * random.uniform(-2.5, 2.5);
			const double b = up + spacing * random.uniform(-2.5, 2.5);
			positions.col(next++) =
				height *
				Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
		}
	}
	const std::vector<char> rejected = rejectedOf(positions);
	EXPECT_LE(countOf(rejected, 0, n), 6);
	EXPECT_GE(countOf(rejected, n, n + 240), 220);
	EXPECT_GE(countOf(rejected, n + 240, n + 490), 225);
}

} // namespace
} // namespace curvature_lines::test
