// Flow, fit and unfolding; singular points walk to their crossings.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "closed_position_field.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "integer_flow.h"
#include "line_density.h"
#include "phase_elements.h"
#include "phase_fit.h"
#include "phase_pins.h"
#include "phase_unfolding.h"
#include "point_cloud.h"
#include "position_field.h"
#include "progress.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// Steps of a singular point from triangle to triangle in one go.
constexpr int longestWalk = 20;

bool isFeature(const TriangleMesh& mesh, const PhasePins& pins, Index e)
{
	return mesh.edges()[e].isRim() || (!pins.crease.empty() && pins.crease[e]);
}

// Rims and creases along which a phase is an integer: its translation is the one without an increase, and stays.
HeldIncreases holdAlongFeatures(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const PhasePins&        pins,
	const Eigen::VectorXcd& rise,
	PositionField&          positions)
{
	HeldIncreases held(mesh.edgeCount(), {0, 0});
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		if (!isFeature(mesh, pins, e))
			continue;
		const int f = std::abs(rise[e].real()) < std::abs(rise[e].imag()) ? 0 : 1;
		if (!pins.fixed[f][edge.from] ||
		    !pins.fixed[familyBehind(field.turns[e], f).family][edge.to])
			continue;
		const Complex step =
			positions.phase[edge.from] - phaseAtEnd(mesh, field, positions.phase, e);
		Complex& n = positions.translations[e];
		n          = f == 0 ? Complex(std::round(step.real()), n.imag())
		                    : Complex(n.real(), std::round(step.imag()));
		held[e][f] = 1;
	}
	return held;
}

// A triangle that is not singular, whatever side c leads to: the transition over it becomes the way around by the two
// other sides. What was in the triangle is then in the neighbour beyond.
void moveOverSide(
	const TriangleMesh& mesh, Index t, int c, CrossField& field, Eigen::VectorXcd& translations)
{
	const TransitionCircuit circuit = circuitOf(mesh, field, translations, t);
	const int               b = (c + 1) % 3, d = (c + 2) % 3;
	// x at corner b is i^-turns x + whole at corner c, by corner d.
	const int     turns = circuit.turns[b] + circuit.turns[d];
	const Complex whole =
		turned(circuit.translation[d], -circuit.turns[b]) + circuit.translation[b];
	const Index e = mesh.edgeOf(t, c);
	// The same from corner b to corner c is the inverse.
	const bool ahead = mesh.isForward(t, c);
	field.turns[e]   = static_cast<std::uint8_t>((ahead ? -turns : turns) & 3);
	translations[e]  = ahead ? -turned(whole, turns) : whole;
	for (const Index changed : {mesh.edges()[e].left, mesh.edges()[e].right})
		field.index[changed] =
			static_cast<std::uint8_t>(circuitOf(mesh, field, translations, changed).index);
}

// The side of a singular triangle beyond which its crossing lies in the plane of the phases, -1: none that it may go over.
int sideToCrossing(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const PhasePins&         pins,
	const std::vector<char>& crossed, // of every edge: not to be crossed again
	const TransitionCircuit& circuit,
	const Eigen::VectorXcd&  phase,
	Index                    t)
{
	const Triangle& corners = mesh.triangles()[t];
	double          least   = 0.0;
	int             side    = -1;
	for (int c = 0; c < 3; ++c) {
		const Index e = mesh.edgeOf(t, c);
		// Of the part of the triangle between the side and the crossing.
		const Complex crossing = circuit.fixedPoint(c), a = phase[corners[c]] - crossing,
					  b = turned(phase[corners[(c + 1) % 3]], -circuit.turns[c]) +
		                  circuit.translation[c] - crossing;
		const double area = a.real() * b.imag() - a.imag() * b.real();
		if (!(area < least) || isFeature(mesh, pins, e) || crossed[e])
			continue;
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		if (field.index[edge.left == t ? edge.right : edge.left] != 0)
			continue;
		least = area;
		side  = c;
	}
	return side;
}

// Singular points walk to the triangle that their crossing is in, but not over rims, creases, or onto each other. Returns
// how many have moved.
int moveToCrossings(
	const TriangleMesh&     mesh,
	const PhasePins&        pins,
	const Eigen::VectorXcd& phase,
	std::vector<char>&      crossed,
	CrossField&             field,
	Eigen::VectorXcd&       translations)
{
	int moved = 0;
	for (const Index start : singularTriangles(field)) {
		Index t = start;
		for (int step = 0; step < longestWalk; ++step) {
			const TransitionCircuit circuit = circuitOf(mesh, field, translations, t);
			const int               side    = circuit.isClosed()
			                                      ? sideToCrossing(mesh, field, pins, crossed, circuit, phase, t)
			                                      : -1;
			if (side < 0)
				break;
			const Index e = mesh.edgeOf(t, side);
			moveOverSide(mesh, t, side, field, translations);
			crossed[e] = 1;
			t          = mesh.edges()[e].left == t ? mesh.edges()[e].right : mesh.edges()[e].left;
		}
		moved += t != start;
	}
	return moved;
}

// Pins leave the element no area: its corners are on one crease, or two are at one crossing, as where creases meet and the
// singular point is.
bool isFlat(const PhaseElement& element, const PhasePins& pins, const Eigen::VectorXcd& phase)
{
	const std::array<Complex, 3> at     = element.phases(phase);
	const auto                   isHeld = [&](int c, int f) {
        const Index v = element.vertex[c];
        return v < 0 || pins.fixed[familyBehind(element.turns[c], f).family][v];
	};
	const auto level = [&](int c, int f) {
		return std::round(f == 0 ? at[c].real() : at[c].imag());
	};
	const auto isSame = [&](int c, int d, int f) {
		return isHeld(c, f) && isHeld(d, f) && level(c, f) == level(d, f);
	};
	for (int f = 0; f < 2; ++f)
		if (isSame(0, 1, f) && isSame(0, 2, f))
			return true;
	for (int c = 0; c < 3; ++c)
		if (isSame(c, (c + 1) % 3, 0) && isSame(c, (c + 1) % 3, 1))
			return true;
	return false;
}

// Elements in which the phases can be as they should.
std::vector<PhaseElement>
soundElements(const PhasePieces& pieces, const PhasePins& pins, const Eigen::VectorXcd& phase)
{
	std::vector<PhaseElement> sound;
	for (std::size_t i = 0; i < pieces.elements.size(); ++i)
		if (pieces.lost[i] == 0.0 && pieces.elements[i].area > 0.0 &&
		    !isFlat(pieces.elements[i], pins, phase))
			sound.push_back(pieces.elements[i]);
	return sound;
}

} // namespace

ClosedPositionField closePositionField(
	const TriangleMesh&   mesh,
	const DirectionGuide& guide,
	CrossField            field,
	const LineDensity&    density,
	const PhasePins&      pins,
	PositionField         positions,
	const ClosingOptions& options,
	const Progress&       progress)
{
	const HeldIncreases held =
		holdAlongFeatures(mesh, field, pins, expectedRise(mesh, field, density), positions);
	positions.translations =
		closeTranslations(mesh, field, density, held, positions.translations, options.flow)
			.translations;
	std::vector<char> crossed(mesh.edgeCount(), 0);
	for (int k = 0; k < options.moves; ++k) {
		fitPhases(
			phasePieces(mesh, field, density, positions.translations, true),
			pins,
			options.drift,
			positions.phase);
		if (moveToCrossings(mesh, pins, positions.phase, crossed, field, positions.translations) ==
		    0)
			break;
		smoothWithTurns(mesh, guide, field);
	}
	ClosedPositionField result;
	result.positions = std::move(positions);
	result.field     = std::move(field);
	layPhases(mesh, density, pins, options, result, progress);
	return result;
}

void layPhases(
	const TriangleMesh&   mesh,
	const LineDensity&    density,
	const PhasePins&      pins,
	const ClosingOptions& options,
	ClosedPositionField&  closed,
	const Progress&       progress)
{
	PositionField&    positions = closed.positions;
	const PhasePieces pieces =
		phasePieces(mesh, closed.field, density, positions.translations, true);
	fitPhases(pieces, pins, options.drift, positions.phase);
	const std::vector<PhaseElement> sound = soundElements(pieces, pins, positions.phase);
	closed.turnedOver.clear();
	for (const Index i : unfoldPhases(mesh, sound, pins, positions.phase, progress))
		closed.turnedOver.push_back(sound[i].triangle);
	finishPositions(mesh, closed.field, positions);
}

} // namespace curvature_lines
