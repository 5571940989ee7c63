// Least-squares phases: exact where evenly spaced lines fit, at the minimum elsewhere, whole where they are pinned.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_fit.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "line_density.h"
#include "phase_elements.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Plane {
	TriangleMesh mesh;
	test::Framed framed; // phase: evenly spaced

	explicit Plane(int cells, double first = 6.0, double second = 4.0) :
			mesh(test::triangulatedPlane(cells, 0.25).mesh)
	{
		framed.field   = test::alongTheAxes(mesh);
		framed.density = LineDensity::Zero(2, mesh.vertexCount());
		framed.density.row(0).setConstant(first);
		framed.density.row(1).setConstant(second);
		framed.translations.setZero(mesh.edgeCount());
		framed.phase.resize(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			framed.phase[v] = {first * mesh.vertices(0, v), second * mesh.vertices(1, v)};
	}
	PhasePieces pieces(bool parted = false) const
	{
		return phasePieces(mesh, framed.field, framed.density, framed.translations, parted);
	}
	PhasePins cornerPins() const // the square's, where both phases are whole
	{
		PhasePins pins(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			if (mesh.vertices.col(v).head<2>().cwiseAbs().minCoeff() > 0.5 - 1e-9)
				pins.fixed[0][v] = pins.fixed[1][v] = 1;
		return pins;
	}
};

Eigen::VectorXcd
disturbed(Eigen::VectorXcd phase, double by, const PhasePins& pins, samples::Random& random)
{
	for (Index v = 0; v < static_cast<Index>(phase.size()); ++v) {
		const Complex noise(random.uniform(-by, by), random.uniform(-by, by));
		phase[v] +=
			Complex(pins.fixed[0][v] ? 0.0 : noise.real(), pins.fixed[1][v] ? 0.0 : noise.imag());
	}
	return phase;
}

TEST(PhaseFit, EvenlySpacedLinesAreFoundFromAnyStart)
{
	const Plane     plane(14);
	samples::Random random(2, 0);
	for (const PhasePins& pins : {plane.cornerPins(), PhasePins(plane.mesh.vertexCount())}) {
		Eigen::VectorXcd phase = disturbed(plane.framed.phase, 5.0, pins, random);
		fitPhases(plane.pieces(), pins, 30.0, phase);
		// Without pins a constant is free.
		const Complex shift = phase[0] - plane.framed.phase[0];
		EXPECT_LT((phase.array() - plane.framed.phase.array() - shift).abs().maxCoeff(), 1e-4);
		if (pins.fixed[0][0]) {
			EXPECT_LT(std::abs(shift), 1e-9);
		}
	}
}

// By their definition, away from the code: nothing near the solution is better.
double energy(const PhasePieces& pieces, double drift, const Eigen::VectorXcd& phase)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < pieces.elements.size(); ++i) {
		const PhaseElement&          element = pieces.elements[i];
		const std::array<Complex, 3> w       = element.phases(phase);
		for (int f = 0; f < 2; ++f) {
			Vector3d gradient = Vector3d::Zero();
			for (int c = 0; c < 3; ++c)
				gradient += (f == 0 ? w[c].real() : w[c].imag()) * element.gradient.col(c);
			const Vector3d across = element.target[f].normalized();
			const double   ahead  = across.dot(gradient - element.target[f]),
						 aside    = element.normal.cross(across).dot(gradient);
			sum += element.area * (ahead * ahead + drift * aside * aside);
		}
	}
	return sum;
}

TEST(PhaseFit, NothingNearIsBetter)
{
	samples::Random           random(3, 0);
	const test::ClosedSurface sphere(test::triangulatedSphere(3), 0.0, 3.0);
	const PhasePieces         pieces = phasePieces(
        sphere.scaffold.mesh,
        sphere.closed.field,
        sphere.density,
        sphere.closed.positions.translations,
        true);
	PhasePins pins(sphere.scaffold.mesh.vertexCount());
	for (Index v = 0; v < sphere.scaffold.mesh.vertexCount(); v += 40)
		pins.fixed[v / 40 % 2][v] = 1;
	for (const double drift : {1.0, 30.0}) {
		Eigen::VectorXcd phase = sphere.closed.positions.phase;
		fitPhases(pieces, pins, drift, phase);
		const double least = energy(pieces, drift, phase);
		for (const double by : {1e-3, 0.03, 0.5})
			for (int trial = 0; trial < 10; ++trial)
				EXPECT_GT(energy(pieces, drift, disturbed(phase, by, pins, random)), least);
		for (Index v = 0; v < sphere.scaffold.mesh.vertexCount(); ++v) {
			if (pins.fixed[0][v]) {
				EXPECT_EQ(phase[v].real(), std::round(sphere.closed.positions.phase[v].real()));
			}
			if (pins.fixed[1][v]) {
				EXPECT_EQ(phase[v].imag(), std::round(sphere.closed.positions.phase[v].imag()));
			}
		}
	}
}

TEST(PhaseFit, FramesDoNotMatter)
{
	Plane           plane(10);
	samples::Random random(4, 0);
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v) // no even solution
		plane.framed.density.col(v) *= random.uniform(0.5, 1.5);
	const PhasePins pins        = plane.cornerPins();
	plane.framed.phase          = disturbed(plane.framed.phase, 1.0, pins, random);
	const auto         quarters = test::randomQuarters(plane.mesh, random);
	test::Framed       other    = test::inTurnedFrames(plane.mesh, plane.framed, quarters);
	const test::Framed before   = other;
	fitPhases(plane.pieces(), pins, 30.0, plane.framed.phase);
	fitPhases(
		phasePieces(plane.mesh, other.field, other.density, other.translations, false),
		pins,
		30.0,
		other.phase);
	EXPECT_GT((other.phase - before.phase).norm(), 0.1);
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
		EXPECT_LT(std::abs(other.phase[v] - turned(plane.framed.phase[v], -quarters[v])), 1e-6);
}

TEST(PhaseFit, LinesThatEndAreLost)
{
	Plane       plane(10);
	const Index e                = plane.mesh.edgeBetween(5 + 11 * 5, 5 + 11 * 6);
	const auto& edge             = plane.mesh.edges()[e];
	plane.framed.translations[e] = {0.0, 2.0};
	const PhasePieces pieces     = plane.pieces();
	ASSERT_EQ(static_cast<Index>(pieces.elements.size()), plane.mesh.triangleCount());
	for (Index t = 0; t < plane.mesh.triangleCount(); ++t)
		EXPECT_EQ(
			pieces.lost[t],
			t == edge.left    ? Complex(0.0, 2.0)
			: t == edge.right ? Complex(0.0, -2.0)
							  : Complex(0.0));
	// They do not disturb the lines around.
	Eigen::VectorXcd phase = plane.framed.phase;
	fitPhases(pieces, plane.cornerPins(), 30.0, phase);
	EXPECT_LT((phase - plane.framed.phase).cwiseAbs().maxCoeff(), 1e-2);
}

TEST(PhaseFit, SingularTrianglesArePartedOrLost)
{
	const test::ClosedSurface sphere(test::triangulatedSphere(3), 0.0, 3.0);
	const TriangleMesh&       mesh = sphere.scaffold.mesh;
	for (const bool parted : {false, true}) {
		const PhasePieces pieces = phasePieces(
			mesh,
			sphere.closed.field,
			sphere.density,
			sphere.closed.positions.translations,
			parted);
		EXPECT_EQ(
			static_cast<Index>(pieces.elements.size()), mesh.triangleCount() + (parted ? 16 : 0));
		ASSERT_EQ(pieces.lost.size(), pieces.elements.size());
		double area = 0.0;
		for (std::size_t i = 0; i < pieces.elements.size(); ++i) {
			area += pieces.elements[i].area;
			const bool singular = sphere.closed.field.index[pieces.elements[i].triangle] != 0;
			EXPECT_EQ(pieces.lost[i], singular && !parted ? Complex(1.0, 1.0) : Complex(0.0));
		}
		EXPECT_NEAR(area, mesh.vertexAreas().sum(), 1e-9);
	}
}

TEST(PhaseFit, EmptyMesh)
{
	Eigen::VectorXcd phase;
	fitPhases(phasePieces(TriangleMesh(), {}, {}, {}, true), PhasePins(), 30.0, phase);
	EXPECT_EQ(phase.size(), 0);
}

} // namespace
} // namespace curvature_lines
