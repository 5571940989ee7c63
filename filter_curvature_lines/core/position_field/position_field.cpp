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
#include "point_cloud.h"
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
// Weights of pins over the largest diagonal, in the start and in the fit: there the pins are exact integers
// afterwards anyway.
constexpr double pinWeight     = 100.0;
constexpr double hardPinWeight = 1e4;
// Weight that holds the phases where they are, over the mean diagonal: the fit leaves a constant free.
constexpr double gauge = 1e-8;
// Weight of triangles where a line ends or the field is singular: there the phase has no gradient like the
// field's.
constexpr double unreliable = 1e-6;

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

Eigen::VectorXcd unwrappedEnds(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const Eigen::VectorXcd& rise,
	const Eigen::VectorXcd& phase)
{
	Eigen::VectorXcd end(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		const Complex             to   = turned(phase[edge.to], -int(field.turns[e]));
		end[e]                         = to + rounded(phase[edge.from] + rise[e] - to);
	}
	return end;
}

// Increase from corner c to corner c + 1, in the frame of corner c.
Complex increase(
	const TriangleMesh&  mesh,
	const CrossField&    field,
	const PositionField& positions,
	Index                triangle,
	int                  c)
{
	const Index   e     = mesh.edgeOf(triangle, c);
	const Complex along = positions.end[e] - positions.phase[mesh.edges()[e].from];
	return mesh.isForward(triangle, c) ? along : -turned(along, field.turns[e]);
}

// Lines that end in the triangle: what is lineEndsIn when the phases are unwrapped around it.
Complex lineEndsIn(
	const TriangleMesh&  mesh,
	const CrossField&    field,
	const PositionField& positions,
	Index                triangle)
{
	const std::array<int, 3> turns = cornerTurns(mesh, field, triangle);
	Complex                  sum   = 0.0;
	for (int c = 0; c < 3; ++c)
		sum += turned(increase(mesh, field, positions, triangle, c), -turns[c]);
	return rounded(sum);
}

// A linear least-squares problem for the phases: unknown 2 v + f is the phase of family f at vertex v.
struct PhaseFit {
	std::vector<Triplet> entries; // of the lower half
	Eigen::VectorXd      right, diagonal;

	explicit PhaseFit(const TriangleMesh& mesh) :
			right(Eigen::VectorXd::Zero(2 * mesh.vertexCount())),
			diagonal(Eigen::VectorXd::Zero(2 * mesh.vertexCount()))
	{
		entries.reserve(18 * mesh.triangleCount() + 2 * mesh.vertexCount());
	}

	// The gradient of family f (seen from corner 0) should be the triangle's target. The phase at corner c
	// in the frame of corner 0 is i^-turns phase + whole[c].
	void addGradient(
		const TriangleField&          tri,
		const Triangle&               corners,
		int                           f,
		const std::array<Complex, 3>& whole,
		double                        weight,
		double                        drift)
	{
		const double   nu     = tri.target[f].norm() + 1e-300;
		const Vector3d across = tri.target[f] / nu, along = tri.normal.cross(across);
		const Vector3d a = tri.gradient.transpose() * across, b = tri.gradient.transpose() * along;
		const Eigen::Matrix3d K = weight * (a * a.transpose() + drift * b * b.transpose());
		Vector3d              unwrapped, sign;
		std::array<Index, 3>  unknown;
		for (int c = 0; c < 3; ++c) {
			const FamilyImage image = familyBehind(tri.turns[c], f);
			unknown[c]              = 2 * corners[c] + image.family;
			sign[c]                 = image.sign;
			unwrapped[c]            = component(whole[c], f);
		}
		const Vector3d pull = weight * nu * a - K * unwrapped;
		for (int i = 0; i < 3; ++i) {
			right[unknown[i]] += sign[i] * pull[i];
			diagonal[unknown[i]] += K(i, i);
			for (int j = 0; j < 3; ++j)
				if (unknown[i] >= unknown[j])
					entries.emplace_back(unknown[i], unknown[j], sign[i] * sign[j] * K(i, j));
		}
	}

	// Pinned phases at the nearest integer; the others lightly where they are.
	void addPins(const PhasePins& pins, const Eigen::VectorXcd& phase)
	{
		const double soft = gauge * diagonal.mean(), hard = hardPinWeight * diagonal.maxCoeff();
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

// One linear least-squares fit of the phases with the whole numbers of all triangles held.
void fit(
	const TriangleMesh&         mesh,
	const CrossField&           field,
	const LineDensity&          density,
	const PhasePins&            pins,
	const PositionFieldOptions& options,
	PositionField&              positions)
{
	PhaseFit problem(mesh);
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const Triangle&        corners = mesh.triangles()[t];
		const TriangleField    tri     = triangleField(mesh, field, density, t);
		const Complex          lost    = lineEndsIn(mesh, field, positions, t);
		const Complex          w0      = positions.phase[corners[0]];
		std::array<Complex, 3> whole   = {0.0, 0.0, 0.0};
		const Complex          d01     = increase(mesh, field, positions, t, 0);
		const Complex          d20 = turned(increase(mesh, field, positions, t, 2), -tri.turns[2]);
		whole[1] = rounded(w0 + d01 - turned(positions.phase[corners[1]], -tri.turns[1]));
		whole[2] = rounded(w0 - d20 - turned(positions.phase[corners[2]], -tri.turns[2]));
		for (int f = 0; f < 2; ++f) {
			const bool   bad    = field.index[t] != 0 || component(lost, f) != 0.0;
			const double weight = tri.area * (bad ? unreliable : 1.0);
			problem.addGradient(tri, corners, f, whole, weight, options.fitDrift);
		}
	}
	problem.addPins(pins, positions.phase);
	const Eigen::VectorXd x = problem.solution();
	if (x.size() == 0)
		return;
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		Vector3d z(x[2 * v], x[2 * v + 1], 0.0);
		for (int f = 0; f < 2; ++f)
			if (pins.fixed[f][v])
				z[f] = std::round(component(positions.phase[v], f));
		positions.phase[v] = {z[0], z[1]};
	}
}

} // namespace

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
	positions.end               = unwrappedEnds(mesh, field, rise, positions.phase);
	for (int k = 0; k < options.rounds; ++k) {
		fit(mesh, field, density, pins, options, positions);
		positions.end = unwrappedEnds(mesh, field, rise, positions.phase);
	}
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		positions.lineEnds += field.index[t] == 0 && lineEndsIn(mesh, field, positions, t) != 0.0;
	return positions;
}

} // namespace curvature_lines
