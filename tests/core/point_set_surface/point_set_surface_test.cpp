// Local quadrics as surfaces, places scattered around points, and how far projection moved points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "control_neighborhood.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

TEST(LocalQuadric, FeetAndNormalsAreThoseOfItsGraph)
{
	samples::Random random(2, 0);
	for (int k = 0; k < 50; ++k) {
		const TangentFrame frame(random.normal3().normalized());
		LocalQuadric       quadric;
		quadric.origin = random.normal3();
		quadric.u      = frame.u;
		quadric.v      = frame.v;
		quadric.n      = frame.n;
		for (int c = 0; c < 6; ++c)
			quadric.c[c] = random.uniform(-0.5, 0.5);
		const Vector3d place = quadric.origin + 0.5 * random.normal3(), foot = quadric.foot(place);
		// Straight below, on the graph: a second time it stays.
		EXPECT_LT((place - foot).cross(quadric.n).norm(), 1e-9);
		EXPECT_LT((quadric.foot(foot) - foot).norm(), 1e-9);
		const Vector3d d = foot - quadric.origin;
		EXPECT_NEAR(quadric.height(d.dot(quadric.u), d.dot(quadric.v)), d.dot(quadric.n), 1e-9);
		// The normal is across both differences along the graph.
		const Vector3d normal = quadric.normalAt(place);
		EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
		EXPECT_GT(normal.dot(quadric.n), 0.0);
		for (const Vector3d& axis : {quadric.u, quadric.v}) {
			const Vector3d step =
				quadric.foot(place + 1e-6 * axis) - quadric.foot(place - 1e-6 * axis);
			EXPECT_NEAR(normal.dot(step.normalized()), 0.0, 1e-6);
		}
	}
}

TEST(ScatterAround, SpreadsOverTheAreaOfOnePoint)
{
	samples::SampleRequest request;
	request.surface                  = "plane";
	request.points                   = 900;
	request.seed                     = 1;
	const auto                sample = samples::generate(request);
	const PointCloud          cloud{sample.positions, sample.normals};
	const double              side = 1.0 / 30.0;
	const std::vector<double> spacing(900, side);
	const ControlPoints       control(cloud, spacing);
	const Eigen::Matrix3Xd    places = cloud.positions.leftCols(40);
	for (const Index count : {1, 5, 20}) {
		const Eigen::Matrix3Xd scattered = scatterAround(control, places, count);
		ASSERT_EQ(scattered.cols(), 40 * count);
		EXPECT_EQ(scattered, scatterAround(control, places, count)); // fixed
		for (Index m = 0; m < 40; ++m) {
			double nearest = 1e9, farthest = 0.0;
			EXPECT_LT((scattered.col(m * count) - places.col(m)).norm(), 1e-12);
			for (Index a = 0; a < count; ++a) {
				const Vector3d d = scattered.col(m * count + a) - places.col(m);
				EXPECT_NEAR(d.z(), 0.0, 1e-9); // in the tangent plane
				farthest = std::max(farthest, d.norm());
				for (Index b = 0; b < a; ++b)
					nearest = std::min(
						nearest,
						(scattered.col(m * count + a) - scattered.col(m * count + b)).norm());
			}
			EXPECT_LE(farthest, side); // the disk of that area has a radius of 0.56 sides
			if (count > 1) {
				EXPECT_GT(farthest, 0.3 * side);
				EXPECT_GT(nearest, 0.25 * side / std::sqrt(double(count)));
			}
		}
	}
}

TEST(ProjectionMoves, CountWhatWasProjectedInTheUnitsWanted)
{
	Eigen::Matrix3Xd from(3, 3);
	from << 0, 1, 5, 0, 0, 5, 0, 0, 5;
	ProjectedPoints points;
	points.positions = from;
	points.positions.col(0) += Eigen::Vector3d(0, 0, 3);
	points.positions.col(1) += Eigen::Vector3d(4, 0, 0);
	points.positions.col(2) += Eigen::Vector3d(9, 9, 9);
	points.projected            = {1, 1, 0};
	const ProjectionMoves moves = movesOf(points, from, 2.0);
	EXPECT_EQ(moves.projected, 2);
	EXPECT_EQ(moves.rms, 2.0 * std::sqrt(12.5));
	EXPECT_EQ(moves.largest, 8.0);
}

TEST(ProjectionMoves, OfNothingAreZero)
{
	ProjectedPoints points;
	points.positions = Eigen::Matrix3Xd::Ones(3, 1);
	points.projected = {0};
	const auto moves = movesOf(points, Eigen::Matrix3Xd::Zero(3, 1));
	EXPECT_EQ(moves.projected, 0);
	EXPECT_EQ(moves.rms, 0.0);
	EXPECT_EQ(moves.largest, 0.0);
}

} // namespace
} // namespace curvature_lines
