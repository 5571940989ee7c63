// Steps along exact directions: they stay on the surface and on their line, are as long as the points allow, and end
// where the cloud does.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "point_cloud.h"
#include "surface_flow.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Flow {
	test::ExactCloud exact;
	UmbilicRegions   umbilics;
	VoronoiCells     cells;
	SurfaceFlow      flow;

	static test::ExactCloud cloudOf(const char* surface, int points)
	{
		samples::SampleRequest request;
		request.surface = surface;
		request.points  = points;
		request.seed    = 4;
		return test::exactCloud(request);
	}
	Flow(const char* surface, int points) :
			exact(cloudOf(surface, points)), umbilics(none(exact.cloud.size())),
			cells(exact.cloud.positions),
			flow(exact.cloud, exact.field, exact.minimum, umbilics, cells, {})
	{
	}
	static UmbilicRegions none(Index n)
	{
		UmbilicRegions umbilics;
		umbilics.umbilic.assign(n, 0);
		umbilics.region.assign(n, -1);
		umbilics.d1 = umbilics.d2 = Eigen::Matrix3Xd::Zero(3, n);
		return umbilics;
	}
	FlowPoint start(Index i, int family) const
	{
		FlowPoint point;
		point.position  = exact.cloud.positions.col(i);
		point.normal    = exact.cloud.normals.col(i);
		point.direction = flow.directionAt(i, family);
		point.family    = family;
		point.cell      = i;
		return point;
	}
};

TEST(SurfaceFlow, StepsAreAboutAQuarterToHalfASpacing)
{
	const Flow torus("torus", 3000);
	for (Index i = 0; i < torus.exact.cloud.size(); ++i) {
		const double spacing = torus.exact.minimum.spacing[i];
		EXPECT_GE(torus.flow.step(i), 0.25 * spacing - 1e-12);
		EXPECT_LE(torus.flow.step(i), 0.5 * spacing + 1e-12);
		EXPECT_LT(torus.flow.leastStep(i), torus.flow.step(i));
		EXPECT_LT(
			test::lineAngle(torus.flow.directionAt(i, 1), torus.exact.sample.d1.col(i)), 1e-6);
		EXPECT_LT(
			test::lineAngle(torus.flow.directionAt(i, 2), torus.exact.sample.d2.col(i)), 1e-6);
	}
}

// Around the tube the angle around the axis stays, around the axis the height does.
TEST(SurfaceFlow, FollowsTheCirclesOfATorus)
{
	const Flow torus("torus", 5000);
	for (const int family : {1, 2})
		for (const Index seed : {3, 50, 700}) {
			FlowPoint    at     = torus.start(seed, family), next;
			const double angle  = std::atan2(at.position.y(), at.position.x()),
						 height = at.position.z();
			for (int k = 0; k < 40; ++k) {
				ASSERT_TRUE(torus.flow.advance(at, 1.0, next));
				const Vector3d d = next.position - at.position;
				EXPECT_GT(d.dot(at.direction), 0.0);
				EXPECT_NEAR(next.arc - at.arc, d.norm(), 0.2 * d.norm() + 1e-12);
				EXPECT_FALSE(torus.flow.leftCloud(next));
				EXPECT_EQ(next.cell, torus.cells.locate(next.position, next.cell));
				const double tube =
					std::hypot(next.position.head<2>().norm() - 1.0, next.position.z());
				EXPECT_NEAR(tube, 0.4, 0.01);
				at = next;
			}
			EXPECT_GT(at.arc, 0.3);
			if (family == 1)
				EXPECT_NEAR(
					std::remainder(
						std::atan2(at.position.y(), at.position.x()) - angle, 2.0 * EIGEN_PI),
					0.0,
					0.05);
			else
				EXPECT_NEAR(at.position.z(), height, 0.05);
		}
}

TEST(SurfaceFlow, ALineKeepsItsDirection)
{
	const Flow torus("torus", 5000);
	FlowPoint  forward = torus.start(8, 1), back = forward, a, b;
	back.direction *= -1.0;
	ASSERT_TRUE(torus.flow.advance(forward, 1.0, a));
	ASSERT_TRUE(torus.flow.advance(back, -1.0, b));
	EXPECT_GT(a.direction.dot(forward.direction), 0.8);
	EXPECT_GT(b.direction.dot(back.direction), 0.8);
	EXPECT_GT(a.arc, 0.0);
	EXPECT_LT(b.arc, 0.0);
}

TEST(SurfaceFlow, LeavesTheCloudAtTheRimOfACylinder)
{
	const Flow cylinder("cylinder", 4000);
	Index      middle = 0; // straight lines run along the second family
	for (Index i = 0; i < cylinder.exact.cloud.size(); ++i)
		if (std::abs(cylinder.exact.cloud.positions(2, i)) <
		    std::abs(cylinder.exact.cloud.positions(2, middle)))
			middle = i;
	FlowPoint at    = cylinder.start(middle, 2), next;
	int       steps = 0;
	while (steps < 500 && cylinder.flow.advance(at, 1.0, next) && !cylinder.flow.leftCloud(next)) {
		at = next;
		++steps;
	}
	EXPECT_GT(steps, 10);
	EXPECT_NEAR(std::abs(at.position.z()), 1.0, 0.1);
	EXPECT_LT(
		std::hypot(
			at.position.x() - cylinder.exact.cloud.positions(0, middle),
			at.position.y() - cylinder.exact.cloud.positions(1, middle)),
		0.05);
}

TEST(SurfaceFlow, CreasesAreWhereNormalsDiffer)
{
	const Flow cube("cube", 3000), torus("torus", 8000);
	Index      creases = 0;
	for (Index i = 0; i < cube.exact.cloud.size(); ++i) {
		const double toEdge =
			samples::surface("cube").featureDistance(cube.exact.cloud.positions.col(i));
		if (cube.flow.isCrease(i)) {
			++creases;
			EXPECT_LT(toEdge, 0.2); // two and a half spacings
		}
	}
	EXPECT_GT(creases, 100);
	// Hardly any where the surface is smooth and the points are dense: beside a gap a bend looks sharp.
	creases = 0;
	for (Index i = 0; i < torus.exact.cloud.size(); ++i)
		creases += torus.flow.isCrease(i);
	EXPECT_LT(creases, 80); // of 8000
}

} // namespace
} // namespace curvature_lines
