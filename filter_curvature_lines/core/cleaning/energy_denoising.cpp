// Global denoising energy (A09 section 4.2) with its analytic gradient, and its minimisation.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy_denoising.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "box_minimization.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

constexpr Index  neighborCount = 6; // K of A09 section 4.2
constexpr double minSine = 0.05; // triangles of a smaller angle have no stable normal; not in A09
// Points below which waking threads costs more than they save.
constexpr Index minParallel = 8192;
// Least double area of a triangle over the mean squared distance of the neighbours: one that collapses during the
// minimisation keeps a finite gradient.
constexpr double minCrossRatio = 1e-3;

NeighborLists
nearestNeighbors(const PointCloud& cloud, const NeighborSearch& search, const Progress& progress)
{
	std::vector<std::vector<Index>> rows(cloud.size());
	parallelFor(cloud.size(), progress, [&](Index i) {
		rows[i]         = search.nearest(cloud.positions.col(i), neighborCount + 1);
		const auto self = std::find(rows[i].begin(), rows[i].end(), i);
		rows[i].erase(self == rows[i].end() && !rows[i].empty() ? rows[i].end() - 1 : self);
	});
	return NeighborLists::fromRows(rows);
}

// Transposed lists: for every point, its places in lists.indices, in increasing order.
NeighborLists placesOf(const NeighborLists& lists, Index points)
{
	NeighborLists places;
	places.offsets.assign(points + 1, 0);
	for (const Index j : lists.indices)
		++places.offsets[j + 1];
	for (Index i = 0; i < points; ++i)
		places.offsets[i + 1] += places.offsets[i];
	places.indices.resize(lists.indices.size());
	std::vector<Index> next(places.offsets.begin(), places.offsets.end() - 1);
	for (std::size_t place = 0; place < lists.indices.size(); ++place)
		places.indices[next[lists.indices[place]]++] = static_cast<Index>(place);
	return places;
}

// An evaluation takes microseconds per point and there are hundreds of them.
template<class Body>
void forEachPoint(Index points, const Body& body)
{
	if (points >= minParallel)
		return parallelFor(points, {}, body);
	for (Index i = 0; i < points; ++i)
		body(i);
}

struct Cost {
	double value, slope; // slope: derivative by e^2
};

// e2 = |n - s nhat|^2. Square root: E's summand with its singularity at 0 rounded off by delta.
Cost costOf(double e2, const EnergyDenoisingOptions& options)
{
	if (options.energy == EnergyDenoisingOptions::Energy::Squared)
		return {e2, 1.0};
	const double smoothed = e2 + options.delta * options.delta;
	const double value    = std::sqrt(std::sqrt(smoothed));
	return {value, 0.25 * value / smoothed};
}

} // namespace

DenoisingEnergy::DenoisingEnergy(
	const PointCloud&             start,
	const NeighborLists&          neighbors,
	const EnergyDenoisingOptions& options) :
		m_options(options), m_normals(start.normals), m_fans(neighbors), m_minCross(start.size()),
		m_uses(placesOf(neighbors, start.size())), m_pulls(3, neighbors.indices.size()),
		m_fanEnergies(start.size())
{
	// At 0 the rounded root has no slope to divide by.
	m_options.delta = std::max(m_options.delta, 1e-6);
	m_firstSign.reserve(start.size());
	for (Index i = 0; i < start.size(); ++i) {
		m_firstSign.push_back(m_signs.size());
		const auto            fan  = m_fans[i];
		const Eigen::Vector3d p    = start.positions.col(i);
		double                mean = 0.0;
		for (Index j = 0; j < fan.size(); ++j) {
			const Eigen::Vector3d a = start.positions.col(fan[j]) - p;
			mean += a.squaredNorm() / fan.size();
			for (Index k = j + 1; k < fan.size(); ++k) {
				const Eigen::Vector3d b    = start.positions.col(fan[k]) - p;
				const Eigen::Vector3d c    = a.cross(b);
				const bool            thin = c.norm() <= minSine * a.norm() * b.norm();
				m_signs.push_back(thin ? 0 : c.dot(m_normals.col(i)) >= 0.0 ? 1 : -1);
			}
		}
		m_minCross[i] = minCrossRatio * mean;
	}
}

double DenoisingEnergy::evaluateFan(Index i, const Eigen::VectorXd& x)
{
	const Index           first = m_fans.offsets[i];
	const auto            fan   = m_fans[i];
	const Eigen::Vector3d p     = x.segment<3>(3 * Eigen::Index(i));
	const Eigen::Vector3d n     = m_normals.col(i);
	const signed char*    sign  = m_signs.data() + m_firstSign[i];
	double                sum   = 0.0;
	m_pulls.middleCols(first, fan.size()).setZero();
	for (Index j = 0; j < fan.size(); ++j) {
		const Eigen::Vector3d a     = x.segment<3>(3 * Eigen::Index(fan[j])) - p;
		Eigen::Vector3d       pullA = Eigen::Vector3d::Zero();
		for (Index k = j + 1; k < fan.size(); ++k) {
			const double s = *sign++;
			if (s == 0.0)
				continue;
			const Eigen::Vector3d b      = x.segment<3>(3 * Eigen::Index(fan[k])) - p;
			const Eigen::Vector3d c      = a.cross(b);
			const double          length = c.norm();
			const bool            tiny   = length < m_minCross[i];
			const double          scale  = 1.0 / (tiny ? m_minCross[i] : length);
			const Eigen::Vector3d nhat   = c * scale;
			const Cost            cost   = costOf((n - s * nhat).squaredNorm(), m_options);
			// d(e^2)/dc = -2 s (n - (n.nhat) nhat) / |c|; below the floor nhat is linear in c.
			const Eigen::Vector3d turn = tiny ? Eigen::Vector3d(nhat - s * n)
			                                  : Eigen::Vector3d(-s * (n - n.dot(nhat) * nhat));
			const Eigen::Vector3d g    = (2.0 * cost.slope * scale) * turn;
			sum += cost.value;
			pullA += b.cross(g);                  // dE/dq
			m_pulls.col(first + k) += g.cross(a); // dE/dr
		}
		m_pulls.col(first + j) += pullA;
	}
	return sum;
}

double DenoisingEnergy::operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
{
	const Index points = static_cast<Index>(m_normals.cols());
	gradient.resize(x.size());
	forEachPoint(points, [&](Index i) { m_fanEnergies[i] = evaluateFan(i, x); });
	forEachPoint(points, [&](Index i) {
		Eigen::Vector3d sum = Eigen::Vector3d::Zero();
		for (const Index place : m_uses[i])
			sum += m_pulls.col(place);
		// A fan moved as a whole keeps its energy: dE/dp = -(sum over its neighbours).
		for (Index place = m_fans.offsets[i]; place < m_fans.offsets[i + 1]; ++place)
			sum -= m_pulls.col(place);
		gradient.segment<3>(3 * Eigen::Index(i)) = sum;
	});
	return m_fanEnergies.sum();
}

EnergyDenoisingResult denoiseByEnergy(
	const PointCloud&             cloud,
	const NeighborSearch&         search,
	const MinimumNeighborhoods&   minimum,
	const EnergyDenoisingOptions& options,
	const Progress&               progress)
{
	EnergyDenoisingResult result;
	result.positions = cloud.positions;
	if (!(minimum.medianSpacing > 0.0))
		return result;

	// The energy has no unit. In spacings its gradient is O(1), which is what line searches expect.
	PointCloud scaled = cloud;
	scaled.positions /= minimum.medianSpacing;
	const bool      nearest = options.neighbors == EnergyDenoisingOptions::Neighbors::Nearest;
	DenoisingEnergy energy(
		scaled,
		nearest ? nearestNeighbors(cloud, search, progress.sub(0.0, 0.05, "Finding neighbors"))
				: minimum.neighbors,
		options);

	const Eigen::VectorXd start =
		Eigen::Map<const Eigen::VectorXd>(scaled.positions.data(), scaled.positions.size());
	const Box       box{start.array() - options.maxMove, start.array() + options.maxMove};
	const Objective objective = [&](const auto& x, auto& gradient) { return energy(x, gradient); };
	const auto      minimize  = options.optimizer == EnergyDenoisingOptions::Optimizer::LBFGSB
	                                ? minimizeLbfgsB
	                                : minimizePolakRibiere;
	Eigen::VectorXd gradient;
	result.initialEnergy = energy(start, gradient);
	const Minimum best =
		minimize(objective, start, box, options.iterations, progress.sub(0.05, 1.0, "Denoising"));

	result.iterations  = best.iterations;
	result.finalEnergy = best.value;
	result.positions =
		minimum.medianSpacing * Eigen::Map<const Eigen::Matrix3Xd>(best.x.data(), 3, cloud.size());
	return result;
}

} // namespace curvature_lines
