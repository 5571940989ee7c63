// Phases with folds come back without, and everything else stays where it was.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_unfolding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "line_density.h"
#include "phase_elements.h"
#include "phase_fit.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

// Half a line per edge of the grid, evenly spaced; phases are pinned on the rim.
struct Plane {
	TriangleMesh              mesh;
	std::vector<PhaseElement> elements;
	Eigen::VectorXcd          phase;
	PhasePins                 pins;

	explicit Plane(int cells, double jitter = 0.2) :
			mesh(test::triangulatedPlane(cells, jitter).mesh), pins(mesh.vertexCount())
	{
		const double      perLength = 0.5 * cells;
		const LineDensity density   = LineDensity::Constant(2, mesh.vertexCount(), perLength);
		elements                    = phasePieces(
                       mesh,
                       test::alongTheAxes(mesh),
                       density,
                       Eigen::VectorXcd::Zero(mesh.edgeCount()),
                       true)
		               .elements;
		phase.resize(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			phase[v] = perLength * Complex(mesh.vertices(0, v), mesh.vertices(1, v));
			if (isOnRim(v))
				pins.fixed[0][v] = pins.fixed[1][v] = 1;
		}
	}
	bool isOnRim(Index v) const { return mesh.vertices.col(v).cwiseAbs().maxCoeff() > 0.5 - 1e-9; }
	std::vector<Index> folded(const Eigen::VectorXcd& at) const
	{
		std::vector<Index> result;
		for (std::size_t i = 0; i < elements.size(); ++i)
			if (!(imageArea(elements[i], at) > 0.0))
				result.push_back(static_cast<Index>(i));
		return result;
	}
};

TEST(PhaseUnfolding, AreasInThePlaneOfThePhases)
{
	const Plane plane(8);
	for (const PhaseElement& element : plane.elements) {
		EXPECT_NEAR(imageArea(element, plane.phase), 1.0, 1e-9);
		EXPECT_NEAR(imageArea(element, 2.0 * plane.phase), 4.0, 1e-9);
		EXPECT_NEAR(imageArea(element, plane.phase.conjugate()), -1.0, 1e-9);
		EXPECT_NEAR(imageArea(element, turned(1.0, 1) * plane.phase), 1.0, 1e-9);
		EXPECT_EQ(imageArea(element, Eigen::VectorXcd::Zero(plane.phase.size())), 0.0);
	}
}

TEST(PhaseUnfolding, WhatHasNoFoldsStaysAsItIs)
{
	const Plane      plane(12);
	Eigen::VectorXcd phase = plane.phase;
	EXPECT_TRUE(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase).empty());
	EXPECT_EQ(phase, plane.phase);
}

TEST(PhaseUnfolding, RandomPhasesComeBackWithoutFolds)
{
	samples::Random random(5, 0);
	for (const double by : {0.5, 1.5, 4.0}) {
		const Plane      plane(12);
		Eigen::VectorXcd phase = plane.phase;
		for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
			if (!plane.isOnRim(v))
				phase[v] += Complex(random.uniform(-by, by), random.uniform(-by, by));
		ASSERT_GT(plane.folded(phase).size(), 10);
		EXPECT_TRUE(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase).empty()) << by;
		EXPECT_TRUE(plane.folded(phase).empty());
		for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
			if (plane.isOnRim(v)) {
				EXPECT_EQ(phase[v], plane.phase[v]);
			}
	}
}

// One vertex is far out: only those near it move.
TEST(PhaseUnfolding, MovesNoMoreThanItMust)
{
	const Plane      plane(40);
	Eigen::VectorXcd phase = plane.phase;
	const Index      bad   = 10 + 41 * 10;
	phase[bad] += Complex(3.0, -2.0);
	ASSERT_FALSE(plane.folded(phase).empty());
	EXPECT_TRUE(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase).empty());
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v) {
		const double away =
			40.0 *
			(plane.mesh.vertices.col(v) - plane.mesh.vertices.col(bad)).cwiseAbs().maxCoeff();
		if (away > 8.5) {
			EXPECT_EQ(phase[v], plane.phase[v]);
		}
	}
	EXPECT_LT(std::abs(phase[bad] - plane.phase[bad]), 1.0);
}

// Two places far apart are as each of them alone.
TEST(PhaseUnfolding, PlacesDoNotFeelEachOther)
{
	const Plane      plane(40);
	const Index      one = 8 + 41 * 8, other = 31 + 41 * 30;
	Eigen::VectorXcd first = plane.phase, second = plane.phase, both = plane.phase;
	first[one] += Complex(3.0, -2.0);
	second[other] += Complex(-2.0, 4.0);
	both[one]   = first[one];
	both[other] = second[other];
	for (Eigen::VectorXcd* phase : {&first, &second, &both})
		EXPECT_TRUE(unfoldPhases(plane.mesh, plane.elements, plane.pins, *phase).empty());
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v) {
		const bool nearOne = v < 41 * 20;
		EXPECT_EQ(both[v], nearOne ? first[v] : second[v]);
	}
}

// Of one phase a vertex may be pinned, and the other free.
TEST(PhaseUnfolding, PinnedPhasesStay)
{
	samples::Random random(6, 0);
	Plane           plane(12);
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
		if (std::abs(plane.phase[v].real()) < 0.15 && !plane.isOnRim(v)) {
			plane.pins.fixed[0][v] = 1;
			plane.phase[v].real(0.0);
		}
	Eigen::VectorXcd phase = plane.phase;
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
		phase[v] += Complex(
			plane.pins.fixed[0][v] ? 0.0 : random.uniform(-1.0, 1.0),
			plane.pins.fixed[1][v] ? 0.0 : random.uniform(-1.0, 1.0));
	const Eigen::VectorXcd before = phase;
	ASSERT_GT(plane.folded(phase).size(), 10);
	EXPECT_TRUE(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase).empty());
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v) {
		if (plane.pins.fixed[0][v]) {
			EXPECT_EQ(phase[v].real(), before[v].real());
		}
		if (plane.pins.fixed[1][v]) {
			EXPECT_EQ(phase[v].imag(), before[v].imag());
		}
	}
	EXPECT_EQ(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase).size(), 0);
}

// Pinned all around, the wrong way: nothing helps, and what is left is named.
TEST(PhaseUnfolding, TellsWhatIsStillTurnedOver)
{
	Plane plane(4);
	plane.pins.fixed[0].assign(plane.mesh.vertexCount(), 1);
	plane.pins.fixed[1].assign(plane.mesh.vertexCount(), 1);
	Eigen::VectorXcd phase = plane.phase;
	phase[6] += Complex(3.0, 0.0);
	const Eigen::VectorXcd   before = phase;
	const std::vector<Index> folded = plane.folded(phase);
	ASSERT_FALSE(folded.empty());
	EXPECT_EQ(unfoldPhases(plane.mesh, plane.elements, plane.pins, phase), folded);
	EXPECT_EQ(phase, before);
}

// The three parts of a singular triangle around their crossing.
TEST(PhaseUnfolding, AroundSingularPoints)
{
	samples::Random           random(8, 0);
	const test::ClosedSurface sphere(test::triangulatedSphere(3), 0.0, 3.0);
	const TriangleMesh&       mesh = sphere.scaffold.mesh;
	const auto                elements =
		phasePieces(
			mesh, sphere.closed.field, sphere.density, sphere.closed.positions.translations, true)
			.elements;
	Eigen::VectorXcd phase = sphere.closed.positions.phase;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		phase[v] += Complex(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
	const auto folds = [&] {
		return std::count_if(elements.begin(), elements.end(), [&](const PhaseElement& element) {
			return !(imageArea(element, phase) > 0.0);
		});
	};
	ASSERT_GT(folds(), 20);
	EXPECT_TRUE(unfoldPhases(mesh, elements, sphere.pins, phase).empty());
	EXPECT_EQ(folds(), 0);
}

} // namespace
} // namespace curvature_lines
