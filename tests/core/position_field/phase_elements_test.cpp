// Elements against the transitions around their triangles: corners, hat functions, the three parts of a singular triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_elements.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "line_density.h"
#include "phase_fit.h"
#include "phase_unfolding.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// The smoothest crosses on a sphere, with whatever phases and whole numbers.
struct RandomSphere {
	TriangleMesh mesh = test::triangulatedSphere(3).mesh;
	test::Framed framed;

	RandomSphere()
	{
		DirectionGuide guide;
		guide.normals    = mesh.vertices;
		guide.directions = mesh.vertices;
		guide.weights.setZero(mesh.vertexCount());
		guide.onCrease.assign(mesh.vertexCount(), 0);
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			guide.directions.col(v) = Vector3d(mesh.vertices.col(v)).unitOrthogonal();
		framed.field = smoothCrossField(mesh, guide);
		samples::Random random(3, 0);
		framed.density.resize(2, mesh.vertexCount());
		framed.phase.resize(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			framed.density.col(v) << random.uniform(2.0, 4.0), random.uniform(2.0, 4.0);
			framed.phase[v] = {random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0)};
		}
		framed.translations = test::randomWholes(mesh, 3, random);
	}
	TransitionCircuit circuit(Index t) const
	{
		return circuitOf(mesh, framed.field, framed.translations, t);
	}
	// The phase at corner c + 1 in the frame of corner c.
	Complex ahead(Index t, int c) const
	{
		const TransitionCircuit around = circuit(t);
		return turned(framed.phase[mesh.triangles()[t][(c + 1) % 3]], -around.turns[c]) +
		       around.translation[c];
	}
};

// Column c is the gradient of what is 1 at corner c and 0 at the others.
void expectHatFunctions(const PhaseElement& element, const std::array<Vector3d, 3>& corners)
{
	for (int c = 0; c < 3; ++c) {
		const Vector3d g = element.gradient.col(c);
		EXPECT_NEAR(g.dot(element.normal), 0.0, 1e-9);
		for (int k = 0; k < 3; ++k)
			EXPECT_NEAR(g.dot(corners[k] - corners[c]), k == c ? 0.0 : -1.0, 1e-9);
	}
}

TEST(PhaseElements, CornersOfTrianglesAreSeenFromTheFirst)
{
	const RandomSphere sphere;
	for (Index t = 0; t < sphere.mesh.triangleCount(); ++t) {
		const TransitionCircuit circuit = sphere.circuit(t);
		const PhaseElement      element =
			wholeTriangle(sphere.mesh, sphere.framed.field, sphere.framed.density, t, circuit);
		const Triangle& corners = sphere.mesh.triangles()[t];
		EXPECT_EQ(element.triangle, t);
		EXPECT_EQ(element.vertex, corners);
		const std::array<Complex, 3> w = element.phases(sphere.framed.phase);
		EXPECT_EQ(w[0], sphere.framed.phase[corners[0]]);
		EXPECT_LT(std::abs(w[1] - sphere.ahead(t, 0)), 1e-12);
		// The first corner, seen from the last one in the frame of that, is where it should be.
		EXPECT_LT(
			std::abs(
				turned(sphere.ahead(t, 2) - sphere.framed.phase[corners[2]], circuit.turns[2]) -
				(w[0] - w[2])),
			1e-12);
		EXPECT_NEAR(element.area, sphere.mesh.areaVector(t).norm(), 1e-12);
		expectHatFunctions(
			element,
			{sphere.mesh.vertices.col(corners[0]),
		     sphere.mesh.vertices.col(corners[1]),
		     sphere.mesh.vertices.col(corners[2])});
	}
}

TEST(PhaseElements, PartsCoverASingularTriangle)
{
	const RandomSphere       sphere;
	const std::vector<Index> singular = singularTriangles(sphere.framed.field);
	ASSERT_EQ(singular.size(), 8);
	for (const Index t : singular) {
		const TransitionCircuit circuit = sphere.circuit(t);
		const auto              parts   = partsAroundFixedPoint(
            sphere.mesh, sphere.framed.field, sphere.framed.density, t, circuit);
		const Triangle& corners = sphere.mesh.triangles()[t];
		const Vector3d  centre  = sphere.mesh.vertices(Eigen::all, corners).rowwise().mean();
		double          area    = 0.0;
		for (int c = 0; c < 3; ++c) {
			const PhaseElement& part = parts[c];
			EXPECT_EQ(part.triangle, t);
			EXPECT_EQ(part.vertex, (std::array<Index, 3>{corners[c], corners[(c + 1) % 3], -1}));
			const std::array<Complex, 3> w = part.phases(sphere.framed.phase);
			EXPECT_EQ(w[0], sphere.framed.phase[corners[c]]);
			EXPECT_LT(std::abs(w[1] - sphere.ahead(t, c)), 1e-12);
			EXPECT_EQ(w[2], circuit.fixedPoint(c));
			area += part.area;
			expectHatFunctions(
				part,
				{sphere.mesh.vertices.col(corners[c]),
			     sphere.mesh.vertices.col(corners[(c + 1) % 3]),
			     centre});
			// Between those of its two corners, in the frame of the first.
			for (int f = 0; f < 2; ++f) {
				const double least = sphere.framed
				                         .density(Eigen::all, {corners[c], corners[(c + 1) % 3]})
				                         .minCoeff(),
							 most = sphere.framed
				                        .density(Eigen::all, {corners[c], corners[(c + 1) % 3]})
				                        .maxCoeff();
				EXPECT_LE(part.target[f].norm(), most + 1e-9);
				EXPECT_GE(part.target[f].norm(), 0.7 * least);
				const Vector3d arm = f == 0 ? sphere.framed.field.d1.col(corners[c])
				                            : sphere.framed.field.d2.col(corners[c]);
				EXPECT_GT(part.target[f].normalized().dot(arm), 0.5);
			}
		}
		EXPECT_NEAR(area, sphere.mesh.areaVector(t).norm(), 1e-12);
	}
}

// On a plane gradients are the densities along the arms.
TEST(PhaseElements, CellsAreAreaTimesDensities)
{
	const TriangleMesh     mesh  = test::triangulatedPlane(6, 0.3).mesh;
	const CrossField       field = test::alongTheAxes(mesh);
	LineDensity            density(2, mesh.vertexCount());
	const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(mesh.edgeCount());
	density.row(0).setConstant(3.0);
	density.row(1).setConstant(5.0);
	double cells = 0.0;
	for (const PhaseElement& element : phasePieces(mesh, field, density, none, true).elements) {
		EXPECT_LT((element.target[0] - 3.0 * Vector3d::UnitX()).norm(), 1e-12);
		EXPECT_LT((element.target[1] - 5.0 * Vector3d::UnitY()).norm(), 1e-12);
		cells += element.cells();
	}
	EXPECT_NEAR(cells, 15.0, 1e-9);
}

TEST(PhaseElements, FramesDoNotMatter)
{
	const RandomSphere sphere;
	samples::Random    random(9, 0);
	const test::Framed other =
		test::inTurnedFrames(sphere.mesh, sphere.framed, test::randomQuarters(sphere.mesh, random));
	const PhasePieces a = phasePieces(
		sphere.mesh, sphere.framed.field, sphere.framed.density, sphere.framed.translations, true);
	const PhasePieces b =
		phasePieces(sphere.mesh, other.field, other.density, other.translations, true);
	ASSERT_EQ(a.elements.size(), b.elements.size());
	for (std::size_t i = 0; i < a.elements.size(); ++i) {
		EXPECT_NEAR(
			imageArea(a.elements[i], sphere.framed.phase),
			imageArea(b.elements[i], other.phase),
			1e-6);
		EXPECT_NEAR(a.elements[i].cells(), b.elements[i].cells(), 1e-12);
		EXPECT_NEAR(std::abs(a.lost[i]), std::abs(b.lost[i]), 1e-12);
	}
}

} // namespace
} // namespace curvature_lines
