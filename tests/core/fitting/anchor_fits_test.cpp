// Height fits at thinned points of surfaces that are known; points off the surface have none.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "anchor_fits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "shuffled_order.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// Points of the unit sphere, and `strays` off it by a tenth of the radius of the balls below.
PointCloud sphere(int points, const std::vector<Vector3d>& strays = {})
{
	samples::SampleRequest request;
	request.surface        = "sphere";
	request.points         = points;
	auto             cloud = samples::generate(request);
	const Index      n     = points + static_cast<Index>(strays.size());
	Eigen::Matrix3Xd positions(3, n), normals(3, n);
	positions.leftCols(points) = cloud.positions;
	normals.leftCols(points)   = cloud.normals;
	for (std::size_t k = 0; k < strays.size(); ++k) {
		positions.col(points + k) = strays[k];
		normals.col(points + k)   = strays[k].normalized();
	}
	const std::vector<Index> order = shuffledOrder(positions);
	return {positions(Eigen::all, order), normals(Eigen::all, order)};
}

constexpr double radius = 0.4;

TEST(AnchorFits, LieOnTheSphereWithItsCurvature)
{
	const PointSample  sample(sphere(4000));
	const PointSubsets subsets(sample, radius);
	const AnchorFits   anchors = fitAnchors(sample, subsets, radius, {true, true});
	ASSERT_GT(anchors.fits.size(), 100u);
	EXPECT_FALSE(anchors.hasOutliers);
	for (const HeightFits& fits : anchors.fits)
		for (const int degree : {2, 4}) {
			const SurfaceElement& e = fits.of(degree);
			ASSERT_TRUE(e.valid);
			EXPECT_NEAR(e.position.norm(), 1.0, degree == 2 ? 2e-3 : 2e-5);
			EXPECT_LT((e.normal - e.position.normalized()).norm(), 1e-2);
			// (k1 + k2) / 2 = 1; a quadric sees that of the caps around
			EXPECT_NEAR(0.5 * e.shape.trace(), 1.0, degree == 2 ? 0.1 : 0.01);
		}
}

TEST(AnchorFits, AreThinnedAndNumberedInTheOrderOfThinning)
{
	const PointSample  sample(sphere(3000));
	const PointSubsets subsets(sample, radius);
	const AnchorFits   full = fitAnchors(sample, subsets, radius, Degrees::only(2));
	const AnchorFits   sketch =
		fitAnchors(sample, subsets, radius, Degrees::only(2), AnchorDetail::Sketch);
	EXPECT_LT(sketch.fits.size(), full.fits.size());
	std::vector<Index> sorted = full.places, counted(full.places.size());
	std::sort(sorted.begin(), sorted.end());
	std::iota(counted.begin(), counted.end(), 0);
	EXPECT_EQ(sorted, counted);
	for (Index a = 0; a < full.points.cols(); ++a)
		for (Index b = 0; b < a; ++b)
			ASSERT_GT((full.points.col(a) - full.points.col(b)).norm(), 0.1 * radius);
	for (const HeightFits& fits : full.fits)
		EXPECT_FALSE(fits.quartic.valid); // not wanted
}

TEST(AnchorFits, OnlyInTheVicinityAskedFor)
{
	const PointSample      sample(sphere(3000));
	const PointSubsets     subsets(sample, radius);
	const Eigen::Matrix3Xd pole = Vector3d::UnitZ();
	const NeighborSearch   poles(pole);
	const Vicinity         vicinity{&poles, 0.5};
	const AnchorFits       all = fitAnchors(sample, subsets, radius, Degrees::only(2));
	const AnchorFits       some =
		fitAnchors(sample, subsets, radius, Degrees::only(2), AnchorDetail::Full, vicinity);
	Index expected = 0;
	for (Index a = 0; a < all.points.cols(); ++a)
		expected += (all.points.col(a) - Vector3d::UnitZ()).norm() < 0.5;
	EXPECT_EQ(some.points.cols(), expected);
	EXPECT_GT(expected, 5);
	for (Index a = 0; a < some.points.cols(); ++a)
		EXPECT_TRUE(vicinity.contains(some.points.col(a)));
	EXPECT_FALSE(vicinity.contains(-Vector3d::UnitZ()));
	EXPECT_TRUE(Vicinity().contains(-Vector3d::UnitZ()));
}

TEST(AnchorFits, APointOffTheSurfaceHasNoFit)
{
	const std::vector<Vector3d> strays = {
		{1.15, 0.0, 0.0}, {0.0, -1.2, 0.0}, {0.0, 0.0, 1.12}, {0.0, 0.9, 0.0}};
	const PointSample  sample(sphere(4000, strays));
	const PointSubsets subsets(sample, radius);
	int                found = 0;
	for (Index i = 0; i < sample.cloud.size(); ++i) {
		const Vector3d p = sample.cloud.positions.col(i);
		if (std::abs(p.norm() - 1.0) < 0.05)
			continue;
		++found;
		const SurfaceElement e =
			surfaceAt(subsets, 0, p, sample.cloud.normals.col(i), {radius, 2}, 2);
		EXPECT_TRUE(!e.valid || isOutlier(e, p, radius)) << p.transpose();
	}
	EXPECT_EQ(found, 4);
	// Points of the sphere are none.
	int tested = 0;
	for (Index i = 0; i < 50; ++i) {
		const Vector3d p = sample.cloud.positions.col(i);
		if (std::abs(p.norm() - 1.0) > 1e-9)
			continue;
		++tested;
		const SurfaceElement e = surfaceAt(subsets, 0, p, p, {radius, 4}, 2);
		EXPECT_TRUE(e.valid && !isOutlier(e, p, radius));
	}
	EXPECT_GT(tested, 40);
}

TEST(AnchorFits, AQuarticFallsBackToTheQuadric)
{
	// 14 points: enough for the six coefficients of a quadric, not for the fifteen of a quartic.
	samples::Random random(3, 0);
	PointCloud      cloud;
	cloud.positions.resize(3, 14);
	cloud.normals.resize(3, 14);
	for (int k = 0; k < 14; ++k) {
		const double   x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3);
		const Vector3d n       = Vector3d(x, y, 1.0).normalized();
		cloud.positions.col(k) = Vector3d(x, y, -0.5 * (x * x + y * y));
		cloud.normals.col(k)   = n;
	}
	const PointSample  sample(cloud);
	const PointSubsets subsets(sample, 0.6);
	const HeightFits   fits =
		surfacesAt(subsets, 0, Vector3d::Zero(), Vector3d::UnitZ(), 0.6, {true, true}, 2);
	ASSERT_TRUE(fits.quadric.valid && fits.quartic.valid);
	EXPECT_EQ(fits.quadric.position, fits.quartic.position);
	EXPECT_EQ(fits.quadric.shape, fits.quartic.shape);
}

} // namespace
} // namespace curvature_lines::test
