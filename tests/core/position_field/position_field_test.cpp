// Phases on exact surfaces: evenly spaced lines, whole numbers where they are pinned and between neighbours, and lines
// that end exactly where the density asks for fewer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "constant_crosses.h"
#include "cross_field.h"
#include "line_density.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using test::CrossedSurface;

LineDensity constantDensity(const CrossedSurface& surface, double first, double second)
{
	LineDensity density(2, surface.surface.size());
	density.row(0).setConstant(first);
	density.row(1).setConstant(second);
	return density;
}

double distanceToWhole(double x)
{
	return std::abs(x - std::round(x));
}

// What every position field is: ends are the other vertex's phase up to whole numbers, and lines end in the
// triangles around which the ends do not close.
void expectSound(const CrossedSurface& surface, const PositionField& positions)
{
	const TriangleMesh& mesh = surface.surface.mesh;
	ASSERT_EQ(positions.phase.size(), mesh.vertexCount());
	ASSERT_EQ(positions.end.size(), mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const Complex whole =
			positions.end[e] -
			turned(positions.phase[mesh.edges()[e].to], -int(surface.field.turns[e]));
		EXPECT_LT(distanceToWhole(whole.real()), 1e-9);
		EXPECT_LT(distanceToWhole(whole.imag()), 1e-9);
		EXPECT_LT(std::abs(whole - positions.translations[e]), 1e-9);
	}
	Index ends = 0;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		if (surface.field.index[t] != 0)
			continue;
		const auto turns = cornerTurns(mesh, surface.field, t);
		Complex    sum   = 0.0;
		for (int c = 0; c < 3; ++c) {
			const Index   e     = mesh.edgeOf(t, c);
			const Complex along = positions.end[e] - positions.phase[mesh.edges()[e].from];
			sum += turned(
				mesh.isForward(t, c) ? along : -turned(along, surface.field.turns[e]), -turns[c]);
		}
		EXPECT_LT(distanceToWhole(sum.real()), 1e-6);
		EXPECT_LT(distanceToWhole(sum.imag()), 1e-6);
		ends += std::abs(sum) > 0.5;
	}
	EXPECT_EQ(positions.lineEnds, ends);
}

// Largest difference between the increase along edges and the one that evenly spaced lines have, in lines.
double unevenness(
	const CrossedSurface& surface, const PositionField& positions, const LineDensity& density)
{
	const Eigen::VectorXcd rise  = expectedRise(surface.surface.mesh, surface.field, density);
	double                 worst = 0.0;
	for (Index e = 0; e < surface.surface.mesh.edgeCount(); ++e)
		worst = std::max(
			worst,
			std::abs(
				positions.end[e] - positions.phase[surface.surface.mesh.edges()[e].from] -
				rise[e]));
	return worst;
}

TEST(PositionField, LinesOnAPlaneAreEvenlySpaced)
{
	for (const double jitter : {0.0, 0.3}) {
		const CrossedSurface plane     = test::crossed(test::triangulatedPlane(20, jitter));
		const LineDensity    density   = constantDensity(plane, 7.3, 4.6);
		const PositionField  positions = positionField(
            plane.surface.mesh, plane.field, density, PhasePins(plane.surface.size()));
		expectSound(plane, positions);
		EXPECT_EQ(positions.lineEnds, 0);
		EXPECT_LT(unevenness(plane, positions, density), 1e-5);
	}
}

// 31.4 lines of length, 31 of which fit around.
TEST(PositionField, AroundACylinderThereIsAWholeNumberOfLines)
{
	const CrossedSurface cylinder = test::crossed(test::triangulatedCylinder(80, 40));
	for (const double perLength : {3.3, 10.0, 9.45}) {
		LineDensity         density   = constantDensity(cylinder, perLength, perLength);
		const PositionField positions = positionField(
			cylinder.surface.mesh, cylinder.field, density, PhasePins(cylinder.surface.size()));
		expectSound(cylinder, positions);
		EXPECT_EQ(positions.lineEnds, 0);
		double once = 0.0;
		for (Index i = 0; i < 80; ++i) {
			const Index  e = cylinder.surface.mesh.edgeBetween(i, (i + 1) % 80);
			const double step =
				std::abs(positions.end[e] - positions.phase[cylinder.surface.mesh.edges()[e].from]);
			EXPECT_NEAR(
				step, EIGEN_PI * perLength / 80.0, 0.03 * EIGEN_PI * perLength / 80.0 + 0.01);
			once += step;
		}
		EXPECT_LT(distanceToWhole(once), 1e-6);
		EXPECT_LE(std::abs(once - EIGEN_PI * perLength), 0.6);
	}
}

TEST(PositionField, OnATorusNoLineNeedsToEnd)
{
	// A line along the tube's circles is as long everywhere; around the axis they are further apart outside, and
	// the density says so.
	const CrossedSurface torus   = test::crossed(test::triangulatedTorus(80, 40));
	LineDensity          density = constantDensity(torus, 5.0, 5.0);
	for (Index v = 0; v < torus.surface.size(); ++v) {
		const Vector3d p      = torus.surface.mesh.vertices.col(v);
		const Vector3d around = Vector3d::UnitZ().cross(p).normalized();
		const bool     first  = std::abs(around.dot(torus.field.d1.col(v))) > 0.7;
		density(first ? 0 : 1, v) = 20.0 / (2.0 * EIGEN_PI * p.head<2>().norm());
	}
	const PositionField positions =
		positionField(torus.surface.mesh, torus.field, density, PhasePins(torus.surface.size()));
	expectSound(torus, positions);
	EXPECT_EQ(positions.lineEnds, 0);
	EXPECT_LT(unevenness(torus, positions, density), 0.1);
}

TEST(PositionField, PinnedVerticesHaveWholeNumbers)
{
	const CrossedSurface plane   = test::crossed(test::triangulatedPlane(20, 0.2));
	const LineDensity    density = constantDensity(plane, 6.2, 6.2);
	PhasePins            pins(plane.surface.size());
	const Vector3d       x(1, 0, 0), y(0, 1, 0);
	for (Index v = 0; v < plane.surface.size(); ++v) {
		const Vector3d p      = plane.surface.mesh.vertices.col(v);
		const int      alongX = std::abs(plane.field.d1.col(v).dot(x)) > 0.7 ? 0 : 1;
		// lines across x run along the sides x = +-0.5
		if (std::abs(std::abs(p.x()) - 0.5) < 1e-9)
			pins.fixed[alongX][v] = 1;
		if (std::abs(std::abs(p.y()) - 0.5) < 1e-9)
			pins.fixed[1 - alongX][v] = 1;
	}
	const PositionField positions = positionField(plane.surface.mesh, plane.field, density, pins);
	expectSound(plane, positions);
	EXPECT_EQ(positions.lineEnds, 0);
	for (Index v = 0; v < plane.surface.size(); ++v) {
		if (pins.fixed[0][v]) {
			EXPECT_EQ(positions.phase[v].real(), std::round(positions.phase[v].real()));
		}
		if (pins.fixed[1][v]) {
			EXPECT_EQ(positions.phase[v].imag(), std::round(positions.phase[v].imag()));
		}
	}
	// From side to side six lines instead of 6.2, everywhere alike.
	EXPECT_LT(unevenness(plane, positions, constantDensity(plane, 6.0, 6.0)), 1e-3);
}

// Ten lines more at one side than at the other: that many end on the way.
TEST(PositionField, LinesEndWhereTheDensityFalls)
{
	const CrossedSurface plane   = test::crossed(test::triangulatedPlane(40));
	LineDensity          density = constantDensity(plane, 10.0, 10.0);
	for (Index v = 0; v < plane.surface.size(); ++v) {
		const bool first = std::abs(plane.field.d1.col(v).x()) > 0.7; // along x
		density(first ? 1 : 0, v) = 15.0 + 10.0 * plane.surface.mesh.vertices(0, v);
	}
	const PositionField positions =
		positionField(plane.surface.mesh, plane.field, density, PhasePins(plane.surface.size()));
	expectSound(plane, positions);
	// Lines that meet the two sides, in whole numbers and counted without those of the same way back.
	double      counts[2] = {0.0, 0.0};
	const auto& mesh      = plane.surface.mesh;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto& edge = mesh.edges()[e];
		for (int side = 0; side < 2; ++side) {
			const double x = side == 0 ? -0.5 : 0.5;
			if (std::abs(mesh.vertices(0, edge.from) - x) < 1e-9 &&
			    std::abs(mesh.vertices(0, edge.to) - x) < 1e-9)
				counts[side] += std::abs(positions.end[e] - positions.phase[edge.from]);
		}
	}
	// Near the sides the fit evens the spacing out a little.
	EXPECT_NEAR(counts[0], 10.0, 2.5);
	EXPECT_NEAR(counts[1], 20.0, 2.5);
	const double more = counts[1] - counts[0];
	EXPECT_GT(more, 5.0);
	EXPECT_GE(positions.lineEnds, more - 1.0);
	EXPECT_LE(positions.lineEnds, more + 6.0);
}

TEST(PositionField, DoesNotChangeWithTheSurfacesPlaceAndSize)
{
	const test::TriangulatedSurface surface = test::triangulatedCylinder(40, 20);
	const test::TriangulatedSurface moved   = test::RigidMotion().of(surface, 3.0);
	const CrossedSurface            a = test::crossed(surface), b = test::crossed(moved);
	const LineDensity               density = constantDensity(a, 4.0, 3.0);
	const PositionField             p =
		positionField(surface.mesh, a.field, density, PhasePins(surface.size()));
	const PositionField q =
		positionField(moved.mesh, b.field, density / 3.0, PhasePins(surface.size()));
	EXPECT_EQ(p.lineEnds, q.lineEnds);
	for (Index e = 0; e < surface.mesh.edgeCount(); ++e) {
		const Index from = surface.mesh.edges()[e].from;
		EXPECT_LT(
			std::abs(std::abs(p.end[e] - p.phase[from]) - std::abs(q.end[e] - q.phase[from])),
			1e-4);
	}
}

// Around a singular point lines cross in it, or not.
TEST(PositionField, CountsSingularTrianglesWithoutACrossing)
{
	CrossedSurface sphere = test::crossed(test::triangulatedSphere(3));
	DirectionGuide guide;
	guide.normals    = sphere.surface.truth.normals;
	guide.directions = sphere.surface.truth.d1;
	guide.weights.setZero(sphere.surface.size());
	guide.onCrease.assign(sphere.surface.size(), 0);
	sphere.field = smoothCrossField(sphere.surface.mesh, guide);
	ASSERT_EQ(singularTriangles(sphere.field).size(), 8);
	PositionField positions = positionField(
		sphere.surface.mesh,
		sphere.field,
		constantDensity(sphere, 3.1, 3.1),
		PhasePins(sphere.surface.size()));
	expectSound(sphere, positions);
	EXPECT_LE(positions.offCrossings, 8);
	// A line more over one side of such a triangle: it is on a crossing if it was not, and the other way round.
	const Index t      = singularTriangles(sphere.field)[0];
	const Index before = positions.offCrossings;
	positions.translations[sphere.surface.mesh.edgeOf(t, 1)] += 1.0;
	finishPositions(sphere.surface.mesh, sphere.field, positions);
	EXPECT_EQ(std::abs(positions.offCrossings - before), 1);
	expectSound(sphere, positions);
}

TEST(PositionField, EmptyMesh)
{
	const PositionField positions = positionField(TriangleMesh(), {}, {}, PhasePins());
	EXPECT_EQ(positions.phase.size(), 0);
	EXPECT_EQ(positions.lineEnds, 0);
}

} // namespace
} // namespace curvature_lines
