// The eigenvector of the periodic energy, and the fit of unwrapped phases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "cross_field.h"
#include "disjoint_sets.h"
#include "line_density.h"
#include "phase_fit.h"
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

constexpr double fullTurn = 2.0 * EIGEN_PI;
// Inverse iteration: the shift over the mean diagonal, and its steps. About 15 steps do on most clouds; 30
// are safe.
constexpr double shift           = 1e-7;
constexpr int    eigenIterations = 30;
// Weight of pins over the largest diagonal.
constexpr double pinWeight = 100.0;
Complex rounded(const Complex& z)
{
	return {std::round(z.real()), std::round(z.imag())};
}

double component(const Complex& z, int f)
{
	return f == 0 ? z.real() : z.imag();
}

// Families that an edge joins are solved for together and share the length of the eigenvector: on a torus
// the two families are two problems, on an ellipsoid one.
std::vector<Index> jointFamilies(const TriangleMesh& mesh, const CrossField& field)
{
	DisjointSets sets(2 * mesh.vertexCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		for (int f = 0; f < 2; ++f)
			sets.join(
				2 * mesh.edges()[e].from + f,
				2 * mesh.edges()[e].to + familyBehind(field.turns[e], f).family);
	std::vector<Index> set(2 * mesh.vertexCount());
	for (Index i = 0; i < 2 * mesh.vertexCount(); ++i)
		set[i] = sets.find(i);
	return set;
}

// The periodic energy sum w |psi(to) - exp(2 pi i rise) psi(from)|^2 over unknowns 4 v + 2 f + {0, 1}: the
// cosine and sine of family f at vertex v. Lower half.
SparseReal periodicEnergy(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const Eigen::VectorXcd& rise,
	double                  drift,
	Eigen::VectorXd&        diagonal)
{
	const Eigen::VectorXd weights = mesh.cotangentWeights();
	std::vector<Triplet>  entries;
	entries.reserve(8 * mesh.edgeCount() + 4 * mesh.vertexCount());
	diagonal.setZero(4 * mesh.vertexCount());
	const auto add = [&](Index row, Index column, double value) {
		entries.emplace_back(std::max(row, column), std::min(row, column), value);
	};
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge    = mesh.edges()[e];
		const bool                fromEnd = field.onCrease[edge.from] && !field.onCrease[edge.to];
		const Vector3d            along   = mesh.along(e);
		// Squared cosines of the edge with the arms; at the end that is not tilted.
		const Index v  = fromEnd ? edge.to : edge.from;
		double      c0 = std::pow(field.d1.col(v).dot(along), 2);
		double      c1 = std::pow(field.d2.col(v).dot(along), 2);
		if (fromEnd && (field.turns[e] & 1))
			std::swap(c0, c1);
		const double sum = c0 + c1 + 1e-300;
		for (int f = 0; f < 2; ++f) {
			const double      share = (f == 0 ? c0 : c1) / sum;
			const double      w     = weights[e] * (share + drift * (1.0 - share));
			const FamilyImage image = familyBehind(field.turns[e], f);
			const Index       from = 4 * edge.from + 2 * f, to = 4 * edge.to + 2 * image.family;
			const double      angle = fullTurn * component(rise[e], f);
			const double      c = w * std::cos(angle), s = w * std::sin(angle);
			for (int k = 0; k < 2; ++k) {
				diagonal[from + k] += w;
				diagonal[to + k] += w;
			}
			// Seen from the start, psi(to) is (cosine, sign sine).
			add(to, from, -c);
			add(to, from + 1, s);
			add(to + 1, from, -image.sign * s);
			add(to + 1, from + 1, -image.sign * c);
		}
	}
	for (Index i = 0; i < diagonal.size(); ++i)
		entries.emplace_back(i, i, diagonal[i]);
	SparseReal matrix(diagonal.size(), diagonal.size());
	matrix.setFromTriplets(entries.begin(), entries.end());
	return matrix;
}

void addToDiagonal(SparseReal& matrix, const Eigen::VectorXd& values)
{
	for (Index i = 0; i < values.size(); ++i)
		matrix.coeffRef(i, i) += values[i];
}

// Of every set of families (by unknown pair: its name), of length 1; inverse iteration. `mass`: of every unknown.
Eigen::VectorXd smallestEigenvectors(
	const Solver& solver, const std::vector<Index>& set, const Eigen::VectorXd& mass)
{
	const auto      pairs = static_cast<Index>(set.size());
	Eigen::VectorXd x(2 * pairs);
	for (Index i = 0; i < pairs;
	     ++i) { // any start that is not orthogonal to the smallest eigenvectors
		const double angle = fullTurn * std::fmod(0.6180339887498949 * i, 1.0);
		x.segment<2>(2 * i) << std::cos(angle), std::sin(angle);
	}
	std::vector<double> length(pairs);
	for (int k = 0; k < eigenIterations; ++k) {
		x = solver.solve(mass.cwiseProduct(x)).eval();
		std::fill(length.begin(), length.end(), 0.0);
		for (Index i = 0; i < pairs; ++i)
			length[set[i]] += mass[2 * i] * x.segment<2>(2 * i).squaredNorm();
		for (Index i = 0; i < pairs; ++i)
			x.segment<2>(2 * i) /= std::sqrt(length[set[i]]) + 1e-300;
	}
	return x;
}

Eigen::VectorXcd periodicStart(
	const TriangleMesh&         mesh,
	const CrossField&           field,
	const Eigen::VectorXcd&     rise,
	const PhasePins&            pins,
	const PositionFieldOptions& options)
{
	const Index              n    = mesh.vertexCount();
	const Eigen::VectorXd    area = mesh.vertexAreas();
	const std::vector<Index> set  = jointFamilies(mesh, field);
	Eigen::VectorXd          mass(4 * n), diagonal;
	for (Index v = 0; v < n; ++v)
		mass.segment<4>(4 * v).setConstant(area[v]);
	SparseReal matrix = periodicEnergy(mesh, field, rise, options.startDrift, diagonal);
	addToDiagonal(matrix, shift * diagonal.mean() / mass.mean() * mass);

	std::vector<char> pinned(2 * n, 0); // by name of set
	Eigen::VectorXd   hard = Eigen::VectorXd::Zero(4 * n), right = Eigen::VectorXd::Zero(4 * n);
	const double      weight = pinWeight * diagonal.maxCoeff();
	for (Index i = 0; i < 2 * n; ++i) {
		if (!pins.fixed[i & 1][i >> 1])
			continue;
		pinned[set[i]] = 1;
		hard.segment<2>(2 * i).setConstant(weight);
		right[2 * i] = weight;
	}
	const auto      isPinned = [&](Index name) { return pinned[name] != 0; };
	Eigen::VectorXd x        = Eigen::VectorXd::Zero(4 * n);
	Solver          solver;
	solver.analyzePattern(matrix);
	if (!std::all_of(set.begin(), set.end(), isPinned)) {
		solver.factorize(matrix);
		x = smallestEigenvectors(solver, set, mass);
	}
	// With pins the phase is no eigenvector but the solution for psi = 1 at the pins. A set of families
	// without any keeps its eigenvector: its solution would be zero.
	if (std::any_of(set.begin(), set.end(), isPinned)) {
		addToDiagonal(matrix, hard);
		solver.factorize(matrix);
		const Eigen::VectorXd solution = solver.solve(right);
		for (Index i = 0; i < 2 * n; ++i)
			if (isPinned(set[i]))
				x.segment<2>(2 * i) = solution.segment<2>(2 * i);
	}
	Eigen::VectorXcd phase(n);
	for (Index v = 0; v < n; ++v)
		phase[v] =
			Complex(std::atan2(x[4 * v + 1], x[4 * v]), std::atan2(x[4 * v + 3], x[4 * v + 2])) /
			fullTurn;
	return phase;
}

// The whole numbers with which the phase increases along every edge as nearly as it should.
Eigen::VectorXcd nearestTranslations(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const Eigen::VectorXcd& rise,
	const Eigen::VectorXcd& phase)
{
	Eigen::VectorXcd result(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		result[e] =
			rounded(phase[mesh.edges()[e].from] + rise[e] - phaseAtEnd(mesh, field, phase, e));
	return result;
}

} // namespace

Complex phaseAtEnd(
	const TriangleMesh& mesh, const CrossField& field, const Eigen::VectorXcd& phase, Index edge)
{
	return turned(phase[mesh.edges()[edge].to], -int(field.turns[edge]));
}

PositionField positionField(
	const TriangleMesh&         mesh,
	const CrossField&           field,
	const LineDensity&          density,
	const PhasePins&            pins,
	const PositionFieldOptions& options)
{
	PositionField positions;
	if (mesh.vertexCount() == 0)
		return positions;
	const Eigen::VectorXcd rise = expectedRise(mesh, field, density);
	positions.phase             = periodicStart(mesh, field, rise, pins, options);
	positions.translations      = nearestTranslations(mesh, field, rise, positions.phase);
	for (int k = 0; k < options.rounds; ++k) {
		fitPhases(
			phasePieces(mesh, field, density, positions.translations, false),
			pins,
			options.fitDrift,
			positions.phase);
		positions.translations = nearestTranslations(mesh, field, rise, positions.phase);
	}
	finishPositions(mesh, field, positions);
	return positions;
}

void finishPositions(const TriangleMesh& mesh, const CrossField& field, PositionField& positions)
{
	positions.end.resize(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		positions.end[e] = phaseAtEnd(mesh, field, positions.phase, e) + positions.translations[e];
	positions.lineEnds = positions.offCrossings = 0;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const TransitionCircuit circuit = circuitOf(mesh, field, positions.translations, t);
		positions.lineEnds += circuit.index == 0 && !circuit.isClosed();
		positions.offCrossings += circuit.index != 0 && !circuit.isClosed();
	}
}

} // namespace curvature_lines
