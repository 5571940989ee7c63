// Direction smoothing energy (A09 section 4.3) as a Hermitian form in exp(2 i theta), and its minimisation.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "direction_smoothing.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <iterator>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>

#include "box_minimization.h"
#include "curvature_field.h"
#include "direction_trust.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Complex = std::complex<double>;

constexpr double maxNormalCosine = 0.5; // 60 degrees: beyond, there is an edge between two points
constexpr Index  maxPartners     = 32;  // of one point's own choice; bounds memory, not the reach
// Added to the diagonal, whose entries are weights up to 1: keeps the linear start well-posed without a data term.
constexpr double startShift = 1e-3;
// Conjugate gradients for the start at most: it need not be exact, the energy is minimised from there.
constexpr int linearIterations = 200;

// The points with positive weight at i, on the same face, by index. Of a larger region every m-th
// one: the same reach at a fraction of the pairs.
std::vector<Index> partnersOf(const PointCloud& cloud, const StatisticalWeights& weights, Index i)
{
	std::vector<Index> partners;
	const auto         row   = weights.neighbors[i];
	const double*      value = weights.values.data() + weights.neighbors.offsets[i];
	for (Index k = 0; k < row.size(); ++k)
		if (row[k] != i && value[k] > 0.0 &&
		    cloud.normals.col(i).dot(cloud.normals.col(row[k])) > maxNormalCosine)
			partners.push_back(row[k]);
	const auto size = static_cast<std::int64_t>(partners.size());
	if (size > maxPartners) {
		for (std::int64_t k = 0; k < maxPartners; ++k)
			partners[k] = partners[k * size / maxPartners];
		partners.resize(maxPartners);
	}
	return partners;
}

NeighborLists transposed(const NeighborLists& lists)
{
	NeighborLists result;
	result.offsets.assign(lists.size() + 1, 0);
	for (const Index j : lists.indices)
		++result.offsets[j + 1];
	for (Index i = 0; i < lists.size(); ++i)
		result.offsets[i + 1] += result.offsets[i];
	result.indices.resize(lists.indices.size());
	std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
	for (Index i = 0; i < lists.size(); ++i)
		for (const Index j : lists[i])
			result.indices[next[j]++] = i;
	return result;
}

// The union with the transposed relation, and every point itself: the pattern of a symmetric
// matrix.
NeighborLists symmetrized(const NeighborLists& lists)
{
	const NeighborLists             others = transposed(lists);
	std::vector<std::vector<Index>> rows(lists.size());
	for (Index i = 0; i < lists.size(); ++i) {
		const auto mine = lists[i], theirs = others[i];
		rows[i].reserve(mine.size() + theirs.size() + 1);
		std::set_union(
			mine.begin(), mine.end(), theirs.begin(), theirs.end(), std::back_inserter(rows[i]));
		rows[i].insert(std::lower_bound(rows[i].begin(), rows[i].end(), i), i);
		rows[i].shrink_to_fit();
	}
	return NeighborLists::fromRows(rows);
}

Eigen::VectorXcd doubledAngles(const Eigen::VectorXd& theta)
{
	Eigen::VectorXcd u(theta.size());
	parallelFor(static_cast<Index>(theta.size()), {}, [&](Index i) {
		u[i] = std::polar(1.0, 2.0 * theta[i]);
	});
	return u;
}

} // namespace

DirectionEnergy::DirectionEnergy(
	const PointCloud& cloud, const CurvatureField& field, double alpha, const Progress& progress) :
		m_alpha(std::clamp(alpha, 0.0, 1.0)), m_theta0(cloud.size()), m_omega(cloud.size())
{
	for (Index i = 0; i < cloud.size(); ++i) {
		const Eigen::Vector2d d = TangentFrame(cloud.normals.col(i)).toPlane(field.d1.col(i));
		m_theta0[i]             = std::atan2(d.y(), d.x());
	}
	const DirectionTrust trust = directionTrust(cloud, field, m_theta0);
	m_omega                    = trust.weight;
	m_u0                       = doubledAngles(m_theta0);
	buildCoupling(cloud, field, trust.turning, progress);
}

void DirectionEnergy::buildCoupling(
	const PointCloud&       cloud,
	const CurvatureField&   field,
	const Eigen::Matrix3Xd& turning,
	const Progress&         progress)
{
	const Index                     n = cloud.size();
	std::vector<std::vector<Index>> chosen(n);
	parallelFor(n, progress.sub(0.0, 0.5, "Pairing directions"), [&](Index i) {
		chosen[i] = partnersOf(cloud, field.weights, i);
	});
	const NeighborLists pattern = symmetrized(NeighborLists::fromRows(chosen));
	m_coupling.resize(n, n);
	m_coupling.resizeNonZeros(pattern.indices.size());
	std::copy(pattern.offsets.begin(), pattern.offsets.end(), m_coupling.outerIndexPtr());
	std::copy(pattern.indices.begin(), pattern.indices.end(), m_coupling.innerIndexPtr());
	m_totalWeight.resize(n);
	parallelFor(n, progress.sub(0.5, 1.0, "Pairing directions"), [&](Index i) {
		const auto         row    = pattern[i];
		auto*              values = m_coupling.valuePtr() + pattern.offsets[i];
		const TangentFrame frame(cloud.normals.col(i));
		m_totalWeight[i] = 0.0;
		Index diagonal   = 0;
		for (Index k = 0; k < row.size(); ++k) {
			const Index j = row[k];
			if (j == i) {
				diagonal = k;
				continue;
			}
			// A row holds the point itself too: the degree is one less than its size.
			const double       w = 1.0 / (row.size() - 1) + 1.0 / (pattern[j].size() - 1);
			const TangentFrame other(cloud.normals.col(j));
			// From the lower index, so that both ends have the same number to the last bit.
			const double phi = i < j ? transportAngle(frame, other) : -transportAngle(other, frame);
			const double turn = 0.5 * (turning.col(i) + turning.col(j))
			                              .dot(cloud.positions.col(i) - cloud.positions.col(j));
			values[k] = std::complex<float>(-m_alpha * std::polar(w, 2.0 * (phi + turn)));
			m_totalWeight[i] += w;
		}
		values[diagonal] = static_cast<float>(dataWeight(i) + m_alpha * m_totalWeight[i]);
	});
}

double DirectionEnergy::dataWeight(Index i) const
{
	return (1.0 - m_alpha) * m_omega[i] + startShift;
}

double DirectionEnergy::operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& gradient) const
{
	// cos^2 psi = (1 + cos 2 psi) / 2, and w_ij cos 2 psi_ij is the real part of conj(u_i) H_ij
	// u_j.
	const Eigen::VectorXcd u = doubledAngles(theta);
	const auto             n = static_cast<Index>(theta.size());
	// added up in order below, however many threads there are
	Eigen::VectorXd data(n), agreement(n);
	gradient.resize(n);
	parallelFor(n, {}, [&](Index i) {
		const Complex turned = u[i] * std::conj(m_u0[i]); // exp(2 i (theta - theta0))
		Complex       sum    = 0.0;                       // -alpha sum_j H_ij u_j
		for (Hermitian::InnerIterator entry(m_coupling, i); entry; ++entry)
			if (entry.col() != i)
				sum += Complex(entry.value()) * u[entry.col()];
		const Complex pair = std::conj(u[i]) * sum; // -alpha sum_j w_ij exp(-2 i psi_ij)
		data[i]            = 0.5 * m_omega[i] * (1.0 - turned.real());
		agreement[i]       = m_alpha * m_totalWeight[i] - pair.real();
		gradient[i]        = (1.0 - m_alpha) * m_omega[i] * turned.imag() + pair.imag();
	});
	return (1.0 - m_alpha) * data.sum() - 0.25 * agreement.sum();
}

// With sin^2(theta - theta0) = |u - u0|^2 / 4 and -cos^2 psi = |u_i - e^(2 i phi) u_j|^2 / 4 - 1
// the minimum solves
//   ((1 - alpha) Omega + alpha (D - H)) u = (1 - alpha) Omega u0.
// The shift acts only where there is no data term (planes, alpha = 1); the solution is then one
// step of the inverse power method towards the smoothest field, started at the input.
Eigen::VectorXd DirectionEnergy::linearStart() const
{
	const auto       n = static_cast<Index>(m_theta0.size());
	Eigen::VectorXcf right(n);
	for (Index i = 0; i < n; ++i)
		right[i] = std::complex<float>(dataWeight(i) * m_u0[i]);
	Eigen::ConjugateGradient<Hermitian, Eigen::Lower | Eigen::Upper> solver;
	solver.setMaxIterations(linearIterations);
	solver.setTolerance(1e-5f);
	solver.compute(m_coupling);
	const Eigen::VectorXcf u = solver.solveWithGuess(right, m_u0.cast<std::complex<float>>());

	Eigen::VectorXd theta = m_theta0;
	for (Eigen::Index i = 0; i < theta.size(); ++i) {
		const Complex turn = Complex(u[i]) * std::conj(m_u0[i]);
		if (std::isfinite(turn.real()) && std::isfinite(turn.imag()) && std::abs(turn) > 1e-6)
			theta[i] += 0.5 * std::arg(turn);
	}
	return theta;
}

DirectionSmoothingResult smoothDirections(
	const PointCloud&                cloud,
	const CurvatureField&            field,
	const DirectionSmoothingOptions& options,
	const Progress&                  progress)
{
	const Index           n = cloud.size();
	const DirectionEnergy energy(
		cloud, field, options.alpha, progress.sub(0.0, 0.2, "Pairing directions"));
	const Objective          objective = std::cref(energy);
	DirectionSmoothingResult result;
	Eigen::VectorXd          gradient;
	Eigen::VectorXd          start = energy.linearStart();
	progress.report(0.4);
	result.initialEnergy = energy(energy.initialAngles(), gradient);
	if (!(energy(start, gradient) < result.initialEnergy))
		start = energy.initialAngles();

	const Minimum best = minimizeLbfgs(
		objective, start, options.iterations, progress.sub(0.4, 1.0, "Smoothing directions"));

	result.iterations  = best.iterations;
	result.finalEnergy = best.value;
	result.d1.resize(3, n);
	result.d2.resize(3, n);
	for (Index i = 0; i < n; ++i) {
		const TangentFrame frame(cloud.normals.col(i));
		result.d1.col(i)  = frame.toSpace({std::cos(best.x[i]), std::sin(best.x[i])});
		result.d2.col(i)  = frame.n.cross(result.d1.col(i));
		const double turn = best.x[i] - energy.initialAngles()[i];
		result.meanTurn += std::abs(std::remainder(turn, EIGEN_PI)) / n;
	}
	return result;
}

} // namespace curvature_lines
