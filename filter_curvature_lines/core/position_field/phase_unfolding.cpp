// The energy and its gradient, in growing neighbourhoods of what is turned over.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_unfolding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "box_minimization.h"
#include "cross_field.h"
#include "disjoint_sets.h"
#include "phase_elements.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "progress.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;

// Elements with less of the area they should have are thin; vertices so many rings around them move, and twice as many
// where that has not been enough after some rounds, a few times. By experiment.
constexpr double thin       = 0.1;
constexpr int    firstReach = 2, patience = 4, levels = 3;
constexpr Index  steps = 60; // of the minimiser, per round
// The regularisation follows the worst element (Garanzha et al., their choice of epsilon squared), but the first round is
// loose, so that elements of no area have a way to go.
constexpr double leastEpsilonSquared = 1e-8, epsilonShare = 0.04, firstEpsilon = 0.05;
// Area against shape, and the least weight of an element over the mean one: small ones must not fold for the sake of large
// ones.
constexpr double areaShare = 0.5, leastWeight = 0.05;
// Derivatives across the own arm cost twice those along it: lines are to follow the directions.
constexpr double acrossShare = 2.0;

// Derivatives of hat functions along two axes of the element, the first over the density of family 0 and of family 1:
// derivative[f](k, c).
struct Axes {
	std::array<Eigen::Matrix<double, 2, 3>, 2> derivative;
	double                                     weight = 0.0;
};

Axes axesOf(const PhaseElement& element, double meanCells)
{
	Axes           result;
	const double   d0 = element.target[0].norm() + 1e-300, d1 = element.target[1].norm() + 1e-300;
	const Vector3d mean = element.target[0] / d0 - element.normal.cross(element.target[1] / d1);
	const Vector3d x    = (mean - mean.dot(element.normal) * element.normal).normalized();
	const Vector3d y    = element.normal.cross(x);
	Eigen::Matrix<double, 2, 3> slopes;
	slopes << x.transpose() * element.gradient, y.transpose() * element.gradient;
	result.derivative = {slopes / d0, slopes / d1};

	result.weight = std::max(leastWeight, element.cells() / meanCells);
	return result;
}

// Row f: derivatives of phase f.
Matrix2d jacobian(const Axes& axes, const std::array<Complex, 3>& phases)
{
	Matrix2d result = Matrix2d::Zero();
	for (int c = 0; c < 3; ++c) {
		result.row(0) += phases[c].real() * axes.derivative[0].col(c).transpose();
		result.row(1) += phases[c].imag() * axes.derivative[1].col(c).transpose();
	}
	return result;
}

struct EnergyGradient {
	double   value;
	Matrix2d gradient; // by the entries of the Jacobian
};

// (shape + area) over the regularised determinant chi, which is positive whatever the determinant.
EnergyGradient energyOf(const Matrix2d& J, double epsilon)
{
	const double det  = J.determinant();
	const double root = std::sqrt(epsilon * epsilon + det * det);
	// (det + root) / 2, without cancellation
	const double   chi   = det > 0.0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
	const double   slope = chi / root;
	const Matrix2d share = (Matrix2d() << 1.0, acrossShare, acrossShare, 1.0).finished();
	const double   shape = J.cwiseAbs2().cwiseProduct(share).sum() + areaShare * (det * det + 1.0);
	const Matrix2d cofactor = (Matrix2d() << J(1, 1), -J(1, 0), -J(0, 1), J(0, 0)).finished();
	return {
		shape / chi,
		2.0 / chi * J.cwiseProduct(share) +
			(2.0 * areaShare * det - shape / chi * slope) / chi * cofactor};
}

std::vector<Index>
turnedOver(const std::vector<PhaseElement>& elements, const Eigen::VectorXcd& phase)
{
	std::vector<Index> result;
	for (std::size_t i = 0; i < elements.size(); ++i)
		if (!(imageArea(elements[i], phase) > 0.0))
			result.push_back(static_cast<Index>(i));
	return result;
}

// Vertices that move together, and the elements around them. No element has corners in two pieces, so that each is a
// problem of its own.
struct Piece {
	std::vector<Index> vertices, elements;
};

// Of the vertices up to so many rings around thin elements, those near one of `folded`.
std::vector<Piece> piecesAround(
	const TriangleMesh&              mesh,
	const std::vector<PhaseElement>& elements,
	const std::vector<Index>&        folded,
	const Eigen::VectorXcd&          phase,
	int                              rings)
{
	std::vector<char> moves(mesh.vertexCount(), 0);
	for (const PhaseElement& element : elements)
		if (imageArea(element, phase) < thin)
			for (const Index v : mesh.triangles()[element.triangle])
				moves[v] = 1;
	for (int r = 0; r < rings; ++r) {
		const std::vector<char> inner = moves;
		for (const TriangleMesh::Edge& edge : mesh.edges())
			if (inner[edge.from] || inner[edge.to])
				moves[edge.from] = moves[edge.to] = 1;
	}
	DisjointSets sets(mesh.vertexCount());
	for (const TriangleMesh::Edge& edge : mesh.edges())
		if (moves[edge.from] && moves[edge.to])
			sets.join(edge.from, edge.to);

	std::vector<Piece> pieces;
	std::vector<Index> pieceOf(mesh.vertexCount(), -1); // by the name of the set
	for (const Index i : folded) {
		Index& piece = pieceOf[sets.find(mesh.triangles()[elements[i].triangle][0])];
		if (piece >= 0)
			continue;
		piece = static_cast<Index>(pieces.size());
		pieces.emplace_back();
	}
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		if (moves[v] && pieceOf[sets.find(v)] >= 0)
			pieces[pieceOf[sets.find(v)]].vertices.push_back(v);
	for (std::size_t i = 0; i < elements.size(); ++i) {
		const auto& corners = elements[i].vertex;
		const auto  moving  = std::find_if(
            corners.begin(), corners.end(), [&](Index v) { return v >= 0 && moves[v]; });
		if (moving != corners.end() && pieceOf[sets.find(*moving)] >= 0)
			pieces[pieceOf[sets.find(*moving)]].elements.push_back(static_cast<Index>(i));
	}
	return pieces;
}

// A piece as an objective of the minimiser: unknown 2 k + f is phase f of its k-th vertex; held ones have a gradient of
// zero.
class LocalProblem {
public:
	LocalProblem(
		const Piece&                     piece,
		const std::vector<PhaseElement>& elements,
		const std::vector<Axes>&         axes,
		const PhasePins&                 pins,
		Eigen::VectorXcd&                phase) :
			m_piece(piece), m_elements(elements), m_axes(axes), m_phase(phase)
	{
		for (const Index v : piece.vertices)
			for (int f = 0; f < 2; ++f)
				m_free.push_back(pins.fixed[f][v] ? 0.0 : 1.0);
		m_number.reserve(piece.elements.size());
		for (const Index i : piece.elements) {
			std::array<Index, 3> number;
			for (int c = 0; c < 3; ++c) {
				const auto at = std::lower_bound(
					piece.vertices.begin(), piece.vertices.end(), elements[i].vertex[c]);
				number[c] = at != piece.vertices.end() && *at == elements[i].vertex[c]
				                ? static_cast<Index>(at - piece.vertices.begin())
				                : -1;
			}
			m_number.push_back(number);
		}
	}

	double leastDeterminant() const
	{
		double least = std::numeric_limits<double>::infinity();
		for (const Index i : m_piece.elements)
			least =
				std::min(least, jacobian(m_axes[i], m_elements[i].phases(m_phase)).determinant());
		return least;
	}

	bool hasFolds() const
	{
		return std::any_of(m_piece.elements.begin(), m_piece.elements.end(), [&](Index i) {
			return !(imageArea(m_elements[i], m_phase) > 0.0);
		});
	}

	void minimize(double epsilon)
	{
		const auto&     vertices = m_piece.vertices;
		Eigen::VectorXd x(2 * vertices.size());
		for (std::size_t k = 0; k < vertices.size(); ++k)
			x.segment<2>(2 * static_cast<Index>(k)) << m_phase[vertices[k]].real(),
				m_phase[vertices[k]].imag();
		const auto objective = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
			setPhases(at);
			return energy(epsilon, gradient);
		};
		setPhases(minimizeLbfgs(objective, x, steps, {}).x);
	}

private:
	void setPhases(const Eigen::VectorXd& x)
	{
		for (std::size_t k = 0; k < m_piece.vertices.size(); ++k)
			m_phase[m_piece.vertices[k]] = {
				x[2 * static_cast<Index>(k)], x[2 * static_cast<Index>(k) + 1]};
	}

	double energy(double epsilon, Eigen::VectorXd& gradient) const
	{
		double sum = 0.0;
		gradient.setZero(2 * static_cast<Index>(m_piece.vertices.size()));
		for (std::size_t k = 0; k < m_piece.elements.size(); ++k) {
			const PhaseElement&  element = m_elements[m_piece.elements[k]];
			const Axes&          axes    = m_axes[m_piece.elements[k]];
			const EnergyGradient local = energyOf(jacobian(axes, element.phases(m_phase)), epsilon);
			sum += axes.weight * local.value;
			for (int c = 0; c < 3; ++c) {
				const Index number = m_number[k][c];
				if (number < 0)
					continue;
				const Complex pull = turned(
					{local.gradient.row(0).dot(axes.derivative[0].col(c)),
				     local.gradient.row(1).dot(axes.derivative[1].col(c))},
					element.turns[c]);
				gradient[2 * number] += axes.weight * pull.real();
				gradient[2 * number + 1] += axes.weight * pull.imag();
			}
		}
		gradient.array() *= Eigen::Map<const Eigen::ArrayXd>(m_free.data(), gradient.size());
		return sum;
	}

	const Piece&                     m_piece;
	const std::vector<PhaseElement>& m_elements; // all
	const std::vector<Axes>&         m_axes;     // all
	Eigen::VectorXcd&                m_phase;    // of all vertices
	std::vector<double>              m_free;     // of every unknown, 0: held
	std::vector<std::array<Index, 3>>
		m_number; // of the piece's elements: places of their corners among its vertices
};

} // namespace

double imageArea(const PhaseElement& element, const Eigen::VectorXcd& phase)
{
	const std::array<Complex, 3> w = element.phases(phase);
	const Complex                a = w[1] - w[0], b = w[2] - w[0];
	return 0.5 * (a.real() * b.imag() - a.imag() * b.real()) / (element.cells() + 1e-300);
}

std::vector<Index> unfoldPhases(
	const TriangleMesh&              mesh,
	const std::vector<PhaseElement>& elements,
	const PhasePins&                 pins,
	Eigen::VectorXcd&                phase,
	const Progress&                  progress)
{
	double cells = 0.0;
	for (const PhaseElement& element : elements)
		cells += element.cells();
	std::vector<Axes> axes;
	axes.reserve(elements.size());
	for (const PhaseElement& element : elements)
		axes.push_back(axesOf(element, cells / double(elements.size())));
	std::vector<Index> folded = turnedOver(elements, phase);
	double             loose  = firstEpsilon;
	for (int level = 0; level < levels && !folded.empty(); ++level, loose = 0.0) {
		const std::vector<Piece> pieces =
			piecesAround(mesh, elements, folded, phase, firstReach << level);
		const auto unfold = [&](Index i) {
			LocalProblem problem(pieces[i], elements, axes, pins, phase);
			for (int k = 0; k < patience && problem.hasFolds(); ++k) {
				const double worst = std::min(0.0, problem.leastDeterminant());
				const double epsilon =
					std::sqrt(leastEpsilonSquared + epsilonShare * worst * worst);
				problem.minimize(k == 0 ? std::max(epsilon, loose) : epsilon);
			}
		};
		parallelFor(
			static_cast<Index>(pieces.size()),
			progress.sub(
				double(level) / levels, double(level + 1) / levels, "unfolding the phases"),
			unfold);
		folded = turnedOver(elements, phase);
	}
	return folded;
}

} // namespace curvature_lines
