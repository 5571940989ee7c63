// From crosses to phases in which no line ends: on exact surfaces, closed and open, smooth and with creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "closed_position_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "constant_crosses.h"
#include "cross_field.h"
#include "phase_elements.h"
#include "phase_fit.h"
#include "phase_unfolding.h"
#include "point_cloud.h"
#include "position_field.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using test::ClosedSurface;

double distanceToWhole(double x)
{
	return std::abs(x - std::round(x));
}

// What every closed position field is.
void expectClosed(const ClosedSurface& surface)
{
	const TriangleMesh&  mesh      = surface.scaffold.mesh;
	const CrossField&    field     = surface.closed.field;
	const PositionField& positions = surface.closed.positions;
	EXPECT_EQ(positions.lineEnds, 0);
	EXPECT_EQ(positions.offCrossings, 0);
	int sum = 0;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const TransitionCircuit circuit = circuitOf(mesh, field, positions.translations, t);
		EXPECT_TRUE(circuit.isClosed());
		ASSERT_EQ(circuit.index, field.index[t]);
		sum += circuit.index;
	}
	for (const std::uint8_t index : surface.openField.index)
		sum -= index;
	EXPECT_EQ(sum % 4, 0); // singular points move, none is made or lost
	EXPECT_EQ(singularTriangles(field).size(), singularTriangles(surface.openField).size());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const Complex whole =
			positions.end[e] - turned(positions.phase[mesh.edges()[e].to], -int(field.turns[e]));
		EXPECT_LT(std::abs(whole - positions.translations[e]), 1e-9);
		EXPECT_EQ(distanceToWhole(positions.translations[e].real()), 0.0);
		EXPECT_EQ(distanceToWhole(positions.translations[e].imag()), 0.0);
	}
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		if (surface.pins.fixed[0][v]) {
			EXPECT_EQ(distanceToWhole(positions.phase[v].real()), 0.0);
		}
		if (surface.pins.fixed[1][v]) {
			EXPECT_EQ(distanceToWhole(positions.phase[v].imag()), 0.0);
		}
	}
}

// None is said to be turned over, and none is.
void expectNoFolds(const ClosedSurface& surface)
{
	EXPECT_TRUE(surface.closed.turnedOver.empty());
	const PhasePieces pieces = phasePieces(
		surface.scaffold.mesh,
		surface.closed.field,
		surface.density,
		surface.closed.positions.translations,
		true);
	for (const PhaseElement& element : pieces.elements)
		EXPECT_GT(imageArea(element, surface.closed.positions.phase), 0.0);
}

int signedSum(const CrossField& field)
{
	int sum = 0;
	for (const std::uint8_t index : field.index)
		sum += index == 3 ? -1 : index;
	return sum;
}

// Nothing is known of directions around its umbilics.
ClosedSurface closedEllipsoid(int levels, double perLength)
{
	const test::CrossedSurface surface = test::crossed(test::triangulatedEllipsoid(levels));
	return {surface.scaffold, directionGuide(surface.scaffold, surface.curvature), perLength};
}

TEST(ClosedPositionField, SmoothClosedSurfaces)
{
	const ClosedSurface torus(test::triangulatedTorus(48, 20), 1.0, 3.7);
	expectClosed(torus);
	expectNoFolds(torus);
	EXPECT_TRUE(singularTriangles(torus.closed.field).empty());

	const ClosedSurface sphere(test::triangulatedSphere(4), 0.0, 4.3);
	expectClosed(sphere);
	expectNoFolds(sphere);
	EXPECT_EQ(std::abs(signedSum(sphere.closed.field)), 8);
	EXPECT_EQ(singularTriangles(sphere.closed.field).size(), 8);

	const ClosedSurface ellipsoid = closedEllipsoid(4, 6.1);
	expectClosed(ellipsoid);
	expectNoFolds(ellipsoid);
	EXPECT_EQ(singularTriangles(ellipsoid.closed.field).size(), 8);
	EXPECT_EQ(std::abs(signedSum(ellipsoid.closed.field)), 8);
}

TEST(ClosedPositionField, SurfacesWithRims)
{
	const ClosedSurface plane(test::triangulatedPlane(20, 0.2), 1.0, 6.3);
	expectClosed(plane);
	expectNoFolds(plane);
	const ClosedSurface cylinder(test::triangulatedCylinder(40, 24), 1.0, 4.4);
	expectClosed(cylinder);
	expectNoFolds(cylinder);
}

// Many more lines at one side than at the other: some have to end, and may do so at a rim only.
TEST(ClosedPositionField, LinesThatTheDensityWouldEndAreLedOn)
{
	ClosedSurface plane(test::triangulatedPlane(32), 1.0, 8.0);
	for (Index v = 0; v < plane.scaffold.mesh.vertexCount(); ++v) {
		const bool first = std::abs(plane.openField.d1.col(v).x()) > 0.7; // along x
		plane.density(first ? 1 : 0, v) = 12.0 + 10.0 * plane.scaffold.mesh.vertices(0, v);
	}
	plane.pins = PhasePins(plane.scaffold.mesh.vertexCount());
	plane.open = positionField(plane.scaffold.mesh, plane.openField, plane.density, plane.pins);
	ASSERT_GT(plane.open.lineEnds, 3);
	plane.closed = closePositionField(
		plane.scaffold.mesh, plane.guide, plane.openField, plane.density, plane.pins, plane.open);
	expectClosed(plane);
	expectNoFolds(plane);
}

// Crossings are up to a cell away from the singular points of the crosses, which walk to them.
TEST(ClosedPositionField, SingularPointsWalkToTheirCrossings)
{
	Index walked = 0;
	for (const double perLength : {2.9, 4.7, 7.3}) {
		const ClosedSurface sphere(test::triangulatedSphere(4), 0.0, perLength);
		ClosingOptions      options;
		options.moves                     = 0;
		const ClosedPositionField unmoved = closePositionField(
			sphere.scaffold.mesh,
			sphere.guide,
			sphere.openField,
			sphere.density,
			sphere.pins,
			sphere.open,
			options);
		EXPECT_EQ(unmoved.field.turns, sphere.openField.turns);
		EXPECT_EQ(unmoved.field.index, sphere.openField.index);
		EXPECT_EQ(unmoved.positions.lineEnds + unmoved.positions.offCrossings, 0);
		// By no more than the lines were moved, and with crosses that are smooth again.
		const auto centre = [&](Index t) {
			return Vector3d(
				sphere.scaffold.mesh.vertices(Eigen::all, sphere.scaffold.mesh.triangles()[t])
					.rowwise()
					.mean());
		};
		for (const Index t : singularTriangles(sphere.closed.field)) {
			double nearest = 2.0;
			for (const Index from : singularTriangles(sphere.openField))
				nearest = std::min(nearest, (centre(t) - centre(from)).norm());
			EXPECT_LT(nearest * perLength, 1.5) << perLength;
			walked += nearest > 0.0;
			// Its crossing is inside: none of its three parts is turned over.
			const TransitionCircuit circuit = circuitOf(
				sphere.scaffold.mesh, sphere.closed.field, sphere.closed.positions.translations, t);
			for (const PhaseElement& part : partsAroundFixedPoint(
					 sphere.scaffold.mesh, sphere.closed.field, sphere.density, t, circuit))
				EXPECT_GT(imageArea(part, sphere.closed.positions.phase), 0.0);
		}
		for (Index v = 0; v < sphere.scaffold.mesh.vertexCount(); ++v) {
			const Vector3d d1 = sphere.closed.field.d1.col(v),
						   n  = sphere.closed.field.normals.col(v);
			EXPECT_NEAR(d1.norm(), 1.0, 1e-9);
			EXPECT_LT((n.cross(d1) - sphere.closed.field.d2.col(v)).norm(), 1e-9);
		}
	}
	EXPECT_GT(walked, 0);
}

TEST(ClosedPositionField, CreasesOfACubeAreLines)
{
	const test::CreasedCube cube(10);
	for (const double perLength : {2.2, 3.7, 5.1}) {
		const ClosedSurface closed(cube.scaffold, cube.guide, perLength);
		expectClosed(closed);
		EXPECT_TRUE(closed.closed.turnedOver.empty());
		const TriangleMesh& mesh      = closed.scaffold.mesh;
		const auto&         positions = closed.closed.positions;
		for (Index e = 0; e < mesh.edgeCount(); ++e) {
			if (!closed.scaffold.creaseEdge[e])
				continue;
			const Complex rise = positions.end[e] - positions.phase[mesh.edges()[e].from];
			EXPECT_LT(std::min(std::abs(rise.real()), std::abs(rise.imag())), 1e-9);
		}
	}
}

// Whole numbers stay, and what the creases have bent becomes even again.
TEST(ClosedPositionField, CreasesThatAreGivenUpHoldNoPhase)
{
	const test::CreasedCube cube(10);
	ClosedSurface           closed(cube.scaffold, cube.guide, 3.7);
	const TriangleMesh&     mesh   = closed.scaffold.mesh;
	const Eigen::VectorXcd  before = closed.closed.positions.translations;
	closed.pins                    = PhasePins(mesh.vertexCount());
	layPhases(mesh, closed.density, closed.pins, {}, closed.closed);
	EXPECT_EQ(closed.closed.positions.translations, before);
	expectClosed(closed);
	expectNoFolds(closed);
	int free = 0;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const Complex rise =
			closed.closed.positions.end[e] - closed.closed.positions.phase[mesh.edges()[e].from];
		free += closed.scaffold.creaseEdge[e] &&
		        std::min(std::abs(rise.real()), std::abs(rise.imag())) > 1e-6;
	}
	EXPECT_GT(free, 20);
}

// Lengths and angles alone count. The triangles are as they were, so that singular points can be told from each other.
TEST(ClosedPositionField, DoesNotChangeWithPlaceAndSize)
{
	for (const char* name : {"torus", "ellipsoid"}) {
		const test::TriangulatedSurface surface = name == std::string("torus")
		                                              ? test::triangulatedTorus(36, 16)
		                                              : test::triangulatedEllipsoid(3);
		const test::TriangulatedSurface moved   = test::RigidMotion().of(surface, 4.0);
		const ClosedSurface             a(surface, 1.0, 4.0), b(moved, 1.0, 1.0);
		expectClosed(a);
		expectClosed(b);
		EXPECT_EQ(singularTriangles(a.closed.field), singularTriangles(b.closed.field));
		EXPECT_EQ(a.closed.turnedOver, b.closed.turnedOver);
		for (Index e = 0; e < surface.mesh.edgeCount(); ++e) {
			const Index from = surface.mesh.edges()[e].from;
			EXPECT_NEAR(
				std::abs(a.closed.positions.end[e] - a.closed.positions.phase[from]),
				std::abs(b.closed.positions.end[e] - b.closed.positions.phase[from]),
				1e-3);
		}
	}
}

TEST(ClosedPositionField, SurfacesTurnedInsideOut)
{
	for (const bool isTorus : {true, false}) {
		test::TriangulatedSurface surface =
			isTorus ? test::triangulatedTorus(36, 16) : test::triangulatedEllipsoid(3);
		std::vector<Triangle> triangles = surface.mesh.triangles();
		for (Triangle& t : triangles)
			std::swap(t[1], t[2]);
		surface.mesh          = TriangleMesh(surface.mesh.vertices, triangles);
		surface.truth.normals = -surface.truth.normals;
		const ClosedSurface closed(surface, 1.0, 4.0);
		expectClosed(closed);
		expectNoFolds(closed);
		EXPECT_EQ(std::abs(signedSum(closed.closed.field)), isTorus ? 0 : 8);
	}
}

TEST(ClosedPositionField, IsTheSameAgain)
{
	const test::TriangulatedSurface surface = test::triangulatedEllipsoid(3);
	const ClosedSurface             a(surface, 1.0, 5.0), b(surface, 1.0, 5.0);
	EXPECT_EQ(a.closed.positions.phase, b.closed.positions.phase);
	EXPECT_EQ(a.closed.positions.end, b.closed.positions.end);
	EXPECT_EQ(a.closed.field.turns, b.closed.field.turns);
}

} // namespace
} // namespace curvature_lines
