// Normal equations of the fit.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_fit.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "cross_field.h"
#include "line_density.h"
#include "phase_elements.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using SparseReal = Eigen::SparseMatrix<double>;
using Solver     = Eigen::SimplicialLDLT<SparseReal, Eigen::Lower>;
using Triplet    = Eigen::Triplet<double>;

// Weight of pins over the largest diagonal: they are exact integers afterwards anyway.
constexpr double pinWeight = 1e4;
// Weight that holds the phases where they are, over the mean diagonal: the fit leaves a constant free.
constexpr double gauge = 1e-8;
// Weight of elements where a line ends or the field is singular.
constexpr double unreliable = 1e-6;

double component(const Complex& z, int f)
{
	return f == 0 ? z.real() : z.imag();
}

// A linear least-squares problem for the phases: unknown 2 v + f is the phase of family f at vertex v.
struct PhaseFit {
	std::vector<Triplet> entries; // of the lower half
	Eigen::VectorXd      right, diagonal;

	PhaseFit(Index vertices, std::size_t elements) :
			right(Eigen::VectorXd::Zero(2 * vertices)),
			diagonal(Eigen::VectorXd::Zero(2 * vertices))
	{
		entries.reserve(18 * elements + 2 * vertices);
	}

	// The gradient of family f should be the element's target.
	void addGradient(const PhaseElement& element, int f, double weight, double drift)
	{
		const double   nu     = element.target[f].norm() + 1e-300;
		const Vector3d across = element.target[f] / nu, along = element.normal.cross(across);
		const Vector3d a        = element.gradient.transpose() * across,
					   b        = element.gradient.transpose() * along;
		const Eigen::Matrix3d K = weight * (a * a.transpose() + drift * b * b.transpose());
		Vector3d              whole, sign;
		std::array<Index, 3>  unknown;
		for (int c = 0; c < 3; ++c) {
			const FamilyImage image = familyBehind(element.turns[c], f);
			unknown[c]              = 2 * element.vertex[c] + image.family; // < 0: a fixed point
			sign[c]                 = image.sign;
			whole[c]                = component(element.whole[c], f);
		}
		const Vector3d pull = weight * nu * a - K * whole;
		for (int i = 0; i < 3; ++i) {
			if (unknown[i] < 0)
				continue;
			right[unknown[i]] += sign[i] * pull[i];
			diagonal[unknown[i]] += K(i, i);
			for (int j = 0; j < 3; ++j)
				if (unknown[j] >= 0 && unknown[i] >= unknown[j])
					entries.emplace_back(unknown[i], unknown[j], sign[i] * sign[j] * K(i, j));
		}
	}

	// Pinned phases at the nearest integer; the others lightly where they are.
	void addPins(const PhasePins& pins, const Eigen::VectorXcd& phase)
	{
		const double soft = gauge * diagonal.mean(), hard = pinWeight * diagonal.maxCoeff();
		for (Index i = 0; i < right.size(); ++i) {
			const double x0     = component(phase[i >> 1], i & 1);
			const bool   pinned = pins.fixed[i & 1][i >> 1];
			const double weight = pinned ? hard : soft;
			entries.emplace_back(i, i, weight);
			right[i] += weight * (pinned ? std::round(x0) : x0);
		}
	}

	// Empty where there is no solution.
	Eigen::VectorXd solution() const
	{
		SparseReal matrix(right.size(), right.size());
		matrix.setFromTriplets(entries.begin(), entries.end());
		const Solver          solver(matrix);
		const Eigen::VectorXd x = solver.solve(right);
		return solver.info() == Eigen::Success && x.allFinite() ? x : Eigen::VectorXd();
	}
};

} // namespace

PhasePieces phasePieces(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const LineDensity&      density,
	const Eigen::VectorXcd& translations,
	bool                    parted)
{
	PhasePieces pieces;
	pieces.elements.reserve(mesh.triangleCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const TransitionCircuit circuit = circuitOf(mesh, field, translations, t);
		if (parted && circuit.index != 0) {
			for (PhaseElement& part : partsAroundFixedPoint(mesh, field, density, t, circuit))
				pieces.elements.push_back(part);
			pieces.lost.resize(pieces.elements.size(), 0.0);
			continue;
		}
		pieces.elements.push_back(wholeTriangle(mesh, field, density, t, circuit));
		pieces.lost.push_back(circuit.index != 0 ? Complex(1.0, 1.0) : circuit.sum);
	}
	return pieces;
}

void fitPhases(
	const PhasePieces& pieces, const PhasePins& pins, double drift, Eigen::VectorXcd& phase)
{
	if (phase.size() == 0)
		return;
	PhaseFit problem(static_cast<Index>(phase.size()), pieces.elements.size());
	for (std::size_t i = 0; i < pieces.elements.size(); ++i)
		for (int f = 0; f < 2; ++f) {
			const PhaseElement& element  = pieces.elements[i];
			const bool          lineEnds = component(pieces.lost[i], f) != 0.0;
			problem.addGradient(element, f, element.area * (lineEnds ? unreliable : 1.0), drift);
		}
	problem.addPins(pins, phase);
	const Eigen::VectorXd x = problem.solution();
	if (x.size() == 0)
		return;
	for (Index v = 0; v < phase.size(); ++v) {
		const auto at = [&](int f) {
			return pins.fixed[f][v] ? std::round(component(phase[v], f)) : x[2 * v + f];
		};
		phase[v] = {at(0), at(1)};
	}
}

} // namespace curvature_lines
