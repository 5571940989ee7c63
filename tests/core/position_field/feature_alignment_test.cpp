// What rims and creases ask of crosses and phases, on surfaces where it is known.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "constant_crosses.h"
#include "cross_field.h"
#include "exact_field.h"
#include "feature_alignment.h"
#include "point_cloud.h"
#include "position_field.h"
#include "rims.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

DirectionGuide guideOf(const test::TriangulatedSurface& surface, double turn, double weight)
{
	DirectionGuide guide;
	guide.normals    = surface.truth.normals;
	guide.directions = std::cos(turn) * surface.truth.d1 + std::sin(turn) * surface.truth.d2;
	guide.weights.setConstant(surface.size(), weight);
	guide.onCrease.assign(surface.size(), 0);
	return guide;
}

TEST(FeatureAlignment, RimsAlongPrincipalDirectionsCount)
{
	const auto             cylinder = test::crossed(test::triangulatedCylinder(40, 12));
	const std::vector<Rim> rims     = findRims(cylinder.surface.mesh);
	DirectionGuide         guide    = guideOf(cylinder.surface, 0.1, 1.0); // 6 degrees off
	const auto             aligned  = alignWithFeatures(cylinder.scaffold, rims, guide);
	const CrossField       field    = smoothCrossField(cylinder.surface.mesh, guide);
	const PhasePins        pins     = featurePins(aligned, field);
	for (Index v = 0; v < cylinder.surface.size(); ++v) {
		const bool onRim = std::abs(std::abs(cylinder.surface.mesh.vertices(2, v)) - 1.0) < 1e-9;
		EXPECT_EQ(aligned.tangents.col(v).norm() > 0.5, onRim);
		EXPECT_EQ(aligned.meeting[v], 0);
		EXPECT_EQ(int(pins.fixed[0][v]) + int(pins.fixed[1][v]), onRim ? 1 : 0);
		if (!onRim)
			continue;
		EXPECT_LT(test::lineAngle(guide.directions.col(v), aligned.tangents.col(v)), 1e-6);
		// The phase that grows across the rim is the one that is whole there.
		const int across = pins.fixed[0][v] ? 0 : 1;
		EXPECT_LT(
			std::abs((across == 0 ? field.d1 : field.d2).col(v).dot(aligned.tangents.col(v))), 0.2);
	}
}

TEST(FeatureAlignment, RimsAcrossTheDirectionsAreLeft)
{
	const auto     cylinder = test::crossed(test::triangulatedCylinder(40, 12));
	DirectionGuide guide    = guideOf(cylinder.surface, EIGEN_PI / 4.0, 1.0);
	const auto     before   = guide.directions;
	const auto     aligned =
		alignWithFeatures(cylinder.scaffold, findRims(cylinder.surface.mesh), guide);
	EXPECT_EQ(aligned.tangents.norm(), 0.0);
	EXPECT_EQ(guide.directions, before);
	// Where no direction is known a rim decides.
	DirectionGuide free = guideOf(cylinder.surface, EIGEN_PI / 4.0, 0.0);
	alignWithFeatures(cylinder.scaffold, findRims(cylinder.surface.mesh), free);
	EXPECT_GT(free.weights.maxCoeff(), 0.0);
}

TEST(FeatureAlignment, BothPhasesAreWholeAtTheCornersOfASquare)
{
	const auto     plane   = test::crossed(test::triangulatedPlane(16));
	DirectionGuide guide   = guideOf(plane.surface, 0.0, 1.0);
	const auto     aligned = alignWithFeatures(plane.scaffold, findRims(plane.surface.mesh), guide);
	const auto     pins    = featurePins(aligned, plane.field);
	for (Index v = 0; v < plane.surface.size(); ++v) {
		const Vector3d p     = plane.surface.mesh.vertices.col(v).cwiseAbs();
		const int      sides = (p.x() > 0.5 - 1e-9) + (p.y() > 0.5 - 1e-9);
		EXPECT_EQ(int(pins.fixed[0][v]) + int(pins.fixed[1][v]), sides);
		EXPECT_EQ(aligned.features.corner[v] != 0, sides == 2);
		EXPECT_EQ(aligned.meeting[v] >= 2, sides == 2);
	}
}

// A crease along x through the middle of the square, and one along y that meets it.
TEST(FeatureAlignment, CreasesAlwaysCountAndMeetInCorners)
{
	auto        plane = test::crossed(test::triangulatedPlane(16));
	const auto& mesh  = plane.surface.mesh;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const Vector3d a = mesh.vertices.col(mesh.edges()[e].from),
					   b = mesh.vertices.col(mesh.edges()[e].to);
		plane.scaffold.creaseEdge[e] =
			(std::abs(a.y()) < 1e-9 && std::abs(b.y()) < 1e-9) ||
			(std::abs(a.x()) < 1e-9 && std::abs(b.x()) < 1e-9 && a.y() > -1e-9 && b.y() > -1e-9);
	}
	DirectionGuide guide   = guideOf(plane.surface, EIGEN_PI / 4.0, 1.0); // against both
	const auto     aligned = alignWithFeatures(plane.scaffold, {}, guide);
	EXPECT_EQ(aligned.features.edge, plane.scaffold.creaseEdge);
	for (Index v = 0; v < plane.surface.size(); ++v) {
		const Vector3d p   = mesh.vertices.col(v);
		const bool     onX = std::abs(p.y()) < 1e-9, onY = std::abs(p.x()) < 1e-9 && p.y() > -1e-9;
		const bool     centre = onX && onY;
		EXPECT_EQ(aligned.features.corner[v] != 0, centre);
		if (centre || (!onX && !onY)) {
			EXPECT_EQ(aligned.tangents.col(v).norm(), 0.0);
			continue;
		}
		const Vector3d along = onX ? Vector3d::UnitX() : Vector3d::UnitY();
		EXPECT_LT(test::lineAngle(aligned.tangents.col(v), along), 1e-6);
		EXPECT_GT(guide.weights[v], 1.0);
	}
}

} // namespace
} // namespace curvature_lines
