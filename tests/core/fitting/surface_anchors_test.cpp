// Anchors on a sphere, which has no edges, and on a cube, whose faces meet at right angles.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_anchors.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "anchor_fits.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "quantile.h"
#include "shuffled_order.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr double radius = 0.2;

// What the anchors of one scale need, in the order it is made.
struct Anchored {
	const samples::AnalyticSurface& surface;
	PointSample                     sample;
	PointSubsets                    subsets;
	AnchorFits                      fits;
	CurvatureScale                  scale;
	SurfaceAnchors                  anchors;

	Anchored(const std::string& name, int points, double normalRadius) :
			surface(samples::surface(name)), sample(cloudOf(name, points)), subsets(sample, radius),
			fits(fitAnchors(sample, subsets, radius, Degrees::only(2))),
			scale(scaleOf(fits, normalRadius)), anchors(fits, subsets, scale, 1e-4)
	{
	}

private:
	static PointCloud cloudOf(const std::string& name, int points)
	{
		samples::SampleRequest request;
		request.surface                = name;
		request.points                 = points;
		request.noise                  = 1e-4;
		const auto               cloud = samples::generate(request);
		const std::vector<Index> order = shuffledOrder(cloud.positions);
		return {cloud.positions(Eigen::all, order), cloud.normals(Eigen::all, order)};
	}
	static CurvatureScale scaleOf(const AnchorFits& fits, double normalRadius)
	{
		std::vector<double> residuals;
		for (const HeightFits& fit : fits.fits)
			if (fit.quadric.valid)
				residuals.push_back(fit.quadric.residual);
		CurvatureScale scale;
		scale.height        = {radius, 2};
		scale.normalRadius  = normalRadius;
		scale.usualResidual = quantileInPlace(residuals, 0.3);
		return scale;
	}
};

TEST(SurfaceAnchors, ASphereHasNoEdgesAndItsCurvature)
{
	const Anchored a("sphere", 8000, 0.3);
	EXPECT_FALSE(a.anchors.hasEdges());
	ASSERT_EQ(a.anchors.size(), static_cast<Index>(a.anchors.elements().size()));
	ASSERT_GT(a.anchors.size(), 100);
	for (Index k = 0; k < a.anchors.size(); k += 7) {
		const SurfaceElement& start = a.anchors.elements()[k];
		EXPECT_FALSE(a.anchors.nearEdge(start.position));
		EXPECT_EQ(a.anchors.onFace(start, start.position).position, start.position);
		const SurfaceElement element = a.anchors.normalField(start);
		ASSERT_TRUE(element.valid);
		EXPECT_NEAR(0.5 * element.shape.trace(), 1.0, 0.05);
		EXPECT_GT(element.normal.dot(start.position.normalized()), 0.9999);
		EXPECT_LT((element.shape * element.normal).norm(), 1e-5);
	}
}

TEST(SurfaceAnchors, KnowTheFacesThatMeetAtTheEdgesOfACube)
{
	const Anchored a("cube", 16000, 0.3);
	ASSERT_TRUE(a.anchors.hasEdges());
	int    near = 0, far = 0;
	double worst = 0.0;
	for (Index i = 0; i < a.sample.cloud.size(); i += 11) {
		const Vector3d foot     = a.surface.project(a.sample.cloud.positions.col(i));
		const double   distance = a.surface.featureDistance(foot);
		// Where three faces meet the nearest edge is not the only one.
		Vector3d sorted = (foot - a.surface.boundingBox().center()).cwiseAbs();
		std::sort(sorted.data(), sorted.data() + 3);
		if (distance > 2.5 * radius) {
			EXPECT_FALSE(a.anchors.nearEdge(foot));
			++far;
		}
		if (distance > 0.5 * radius || distance < 0.1 * radius || sorted[0] > 0.1)
			continue;
		++near;
		EXPECT_TRUE(a.anchors.nearEdge(foot));
		EdgeNearby           edge;
		const SurfaceElement face = a.anchors.faceAt(foot, &edge);
		ASSERT_TRUE(face.valid);
		EXPECT_GT(face.normal.dot(a.surface.frame(foot).normal), 0.999);
		EXPECT_LT((face.position - foot).norm(), 0.02 * radius);
		EXPECT_NEAR(edge.angle, 0.5 * EIGEN_PI, 0.05);
		worst = std::max(worst, std::abs(edge.distance - distance));
		// A plane, although an edge runs through the ball.
		const SurfaceElement element = a.anchors.normalField(face);
		EXPECT_TRUE(!element.valid || element.shape.norm() < 0.5);
	}
	EXPECT_GT(near, 20);
	EXPECT_LT(worst, 0.05 * radius);
}

} // namespace
} // namespace curvature_lines::test
