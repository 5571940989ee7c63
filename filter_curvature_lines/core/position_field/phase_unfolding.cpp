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
// when that has not been enough for some rounds. By experiment.
constexpr double thin       = 0.1;
constexpr int    firstReach = 5, patience = 4, mostRounds = 12;
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
	const double root = std::hypot(epsilon, det);
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

// The vertices that may move and the elements around them, as an objective of the minimiser: unknown 2 k + f is phase f of
// the k-th of these vertices; held ones have a gradient of zero.
class LocalProblem {
public:
	LocalProblem(
		const std::vector<PhaseElement>& elements,
		const std::vector<Axes>&         axes,
		const std::vector<char>&         moves, // of every vertex
		const PhasePins&                 pins,
		Eigen::VectorXcd&                phase) : m_phase(phase)
	{
		m_number.assign(moves.size(), -1);
		for (std::size_t v = 0; v < moves.size(); ++v) {
			if (!moves[v])
				continue;
			m_number[v] = static_cast<Index>(m_vertices.size());
			m_vertices.push_back(static_cast<Index>(v));
			for (int f = 0; f < 2; ++f)
				m_free.push_back(pins.fixed[f][v] ? 0.0 : 1.0);
		}
		for (std::size_t i = 0; i < elements.size(); ++i)
			if (std::any_of(elements[i].vertex.begin(), elements[i].vertex.end(), [&](Index v) {
					return v >= 0 && moves[v];
				})) {
				m_elements.push_back(&elements[i]);
				m_axes.push_back(&axes[i]);
			}
	}

	double leastDeterminant() const
	{
		double least = std::numeric_limits<double>::infinity();
		for (std::size_t i = 0; i < m_elements.size(); ++i)
			least =
				std::min(least, jacobian(*m_axes[i], m_elements[i]->phases(m_phase)).determinant());
		return least;
	}

	void minimize(double epsilon, const Progress& progress)
	{
		Eigen::VectorXd x(2 * m_vertices.size());
		for (std::size_t k = 0; k < m_vertices.size(); ++k)
			x.segment<2>(2 * static_cast<Index>(k)) << m_phase[m_vertices[k]].real(),
				m_phase[m_vertices[k]].imag();
		const auto objective = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
			setPhases(at);
			return energy(epsilon, gradient);
		};
		setPhases(minimizeLbfgs(objective, x, steps, progress).x);
	}

private:
	void setPhases(const Eigen::VectorXd& x)
	{
		for (std::size_t k = 0; k < m_vertices.size(); ++k)
			m_phase[m_vertices[k]] = {
				x[2 * static_cast<Index>(k)], x[2 * static_cast<Index>(k) + 1]};
	}

	double energy(double epsilon, Eigen::VectorXd& gradient) const
	{
		double sum = 0.0;
		gradient.setZero(2 * static_cast<Index>(m_vertices.size()));
		for (std::size_t i = 0; i < m_elements.size(); ++i) {
			const PhaseElement&  element = *m_elements[i];
			const Axes&          axes    = *m_axes[i];
			const EnergyGradient local = energyOf(jacobian(axes, element.phases(m_phase)), epsilon);
			sum += axes.weight * local.value;
			for (int c = 0; c < 3; ++c) {
				const Index v = element.vertex[c];
				if (v < 0 || m_number[v] < 0)
					continue;
				const Complex pull = turned(
					{local.gradient.row(0).dot(axes.derivative[0].col(c)),
				     local.gradient.row(1).dot(axes.derivative[1].col(c))},
					element.turns[c]);
				gradient[2 * m_number[v]] += axes.weight * pull.real();
				gradient[2 * m_number[v] + 1] += axes.weight * pull.imag();
			}
		}
		gradient.array() *= Eigen::Map<const Eigen::ArrayXd>(m_free.data(), gradient.size());
		return sum;
	}

	Eigen::VectorXcd&   m_phase;
	std::vector<Index>  m_vertices, m_number; // that move; of every vertex its place among them
	std::vector<double> m_free;               // of every unknown, 0: held
	std::vector<const PhaseElement*> m_elements;
	std::vector<const Axes*>         m_axes;
};

// Vertices up to so many rings around thin elements.
std::vector<char> around(
	const TriangleMesh&              mesh,
	const std::vector<PhaseElement>& elements,
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
	return moves;
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
	int                reach  = firstReach;
	for (int round = 0; round < mostRounds && !folded.empty(); reach *= 2) {
		LocalProblem problem(elements, axes, around(mesh, elements, phase, reach), pins, phase);
		for (int k = 0; k < patience && !folded.empty(); ++k, ++round) {
			const double worst   = std::min(0.0, problem.leastDeterminant());
			const double epsilon = std::sqrt(leastEpsilonSquared + epsilonShare * worst * worst);
			problem.minimize(round == 0 ? std::max(epsilon, firstEpsilon) : epsilon, progress);
			folded = turnedOver(elements, phase);
		}
	}
	return folded;
}

} // namespace curvature_lines
