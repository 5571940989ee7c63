// The distance between lines of curvature (A09 section 5.1) and the epsilon for a wanted number of crossings.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <boost/math/tools/toms748_solve.hpp>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// The automatic bounds of d(kappa): A09 has none. Lines nearer than two median spacings run through
// the same points; a tenth of the diagonal is where flat parts, whose d(kappa) is infinite, get lines at all.
constexpr double automaticLeast = 2.0; // median spacings
constexpr double automaticMost  = 0.1; // diagonals of the bounding box
// Median spacings, below which no distance is taken, asked for or not: the cloud does not resolve such
// lines.
constexpr double smallestLeast = 0.5;
// With a target count the bounds go up to so many times the mean distance it needs, and down to 1 / it: on
// a cylinder or plane one family is at its upper bound. By experiment on those.
constexpr double targetRange = 2.0;
// Where epsilon is looked for, in diagonals: below and above, all lines are at a bound of their distance.
constexpr double         smallestEpsilon = 1e-12, largestEpsilon = 1.0;
constexpr double         epsilonTolerance = 3e-5; // relative
constexpr std::uintmax_t mostEvaluations  = 40;   // a safeguard
// Area of a point's share of the surface in units of its squared spacing: the mean distance to the nearest
// neighbours in six slices is 1.22 / sqrt(density) in random clouds, and 0.67 = 1 / 1.22^2.
constexpr double shareOfSpacing = 0.67;
// Mean distance of lines over d: they start at d from the next one and end below stopFactor d. Measured.
constexpr double realisedDistance = 1.15;

struct Bounds {
	double least, most;
};

// d(kappa) jumps to its upper bound and back within a few spacings where the curvature across changes sign,
// and no line would get through. Mesh sizing fields are graded for that reason: d grows by no more than
// `gradation` times the distance.
class GradedDistances {
public:
	GradedDistances(
		const PointCloud&           cloud,
		const CurvatureField&       field,
		const MinimumNeighborhoods& minimum,
		double                      gradation);

	// Of family 0 along d1 and family 1 along d2.
	std::vector<double> operator()(int family, double epsilon, const Bounds& bounds) const;

private:
	const NeighborLists&                  m_neighbors;
	std::vector<double>                   m_growth; // to each of the neighbours
	std::array<const Eigen::VectorXd*, 2> m_across; // curvature across the lines
	// the more bent the smaller is d(kappa), for any epsilon
	std::array<std::vector<Index>, 2> m_byBound;
};

GradedDistances::GradedDistances(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	double gradation) : m_neighbors(minimum.neighbors), m_across{&field.k2, &field.k1}
{
	m_growth.reserve(m_neighbors.indices.size());
	for (Index i = 0; i < cloud.size(); ++i)
		for (const Index j : m_neighbors[i])
			m_growth.push_back(
				gradation * (cloud.positions.col(j) - cloud.positions.col(i)).norm());
	for (int family = 0; family < 2; ++family) {
		const Eigen::VectorXd& across = *m_across[family];
		std::vector<Index>&    order  = m_byBound[family];
		order.resize(cloud.size());
		std::iota(order.begin(), order.end(), 0);
		std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
			return std::abs(across[a]) > std::abs(across[b]);
		});
	}
}

std::vector<double>
GradedDistances::operator()(int family, double epsilon, const Bounds& bounds) const
{
	const Eigen::VectorXd&    across = *m_across[family];
	const std::vector<Index>& order  = m_byBound[family];
	std::vector<double>       d(order.size());
	for (std::size_t i = 0; i < d.size(); ++i)
		d[i] = lineSpacing(across[i], epsilon, bounds.least, bounds.most);

	// Dijkstra from all points at once: in the order of d, those that were lowered among the others.
	using Entry = std::pair<double, Index>;
	std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> lowered;
	std::size_t                                                         next = 0;
	while (next < d.size() || !lowered.empty()) {
		Index i = 0;
		if (next < d.size() && (lowered.empty() || d[order[next]] <= lowered.top().first)) {
			i = order[next++];
		}
		else {
			i                  = lowered.top().second;
			const double value = lowered.top().first;
			lowered.pop();
			if (value > d[i])
				continue;
		}
		for (Index k = m_neighbors.offsets[i]; k < m_neighbors.offsets[i + 1]; ++k) {
			const Index  j     = m_neighbors.indices[k];
			const double limit = d[i] + m_growth[k];
			if (limit < d[j]) {
				d[j] = limit;
				lowered.emplace(limit, j);
			}
		}
	}
	return d;
}

double surfaceArea(const MinimumNeighborhoods& minimum)
{
	double sum = 0.0;
	for (double h : minimum.spacing)
		sum += shareOfSpacing * h * h;
	return sum;
}

// Two families at distances c d1 and c d2 cross once in every c d1 by c d2 of surface.
double
predictedCrossings(const MinimumNeighborhoods& minimum, const std::array<std::vector<double>, 2>& d)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < d[0].size(); ++i) {
		const double h = minimum.spacing[i];
		sum += shareOfSpacing * h * h / (realisedDistance * realisedDistance * d[0][i] * d[1][i]);
	}
	return sum;
}

// The epsilon, in diagonals, with which `predict` expects that many crossings: ever fewer as it grows. One of
// the ends where there is none.
template<class Predict>
double epsilonFor(double crossings, const Predict& predict)
{
	const auto surplus = [&](double logarithm) {
		return std::log(predict(std::exp(logarithm)) / crossings);
	};
	const double low = std::log(smallestEpsilon), high = std::log(largestEpsilon);
	const double atLow = surplus(low), atHigh = surplus(high);
	if (!(atLow > 0.0))
		return smallestEpsilon;
	if (!(atHigh < 0.0))
		return largestEpsilon;
	const auto     settled = [](double a, double b) { return std::abs(b - a) < epsilonTolerance; };
	std::uintmax_t evaluations = mostEvaluations;
	const auto     bracket =
		boost::math::tools::toms748_solve(surplus, low, high, atLow, atHigh, settled, evaluations);
	return std::exp(0.5 * (bracket.first + bracket.second));
}

Bounds spacingBounds(
	const MinimumNeighborhoods& minimum,
	const LineSpacingOptions&   options,
	double                      diagonal,
	double                      crossings)
{
	const double median = minimum.medianSpacing;
	Bounds       bounds = {automaticLeast * median, automaticMost * diagonal};
	if (crossings > 0.0) {
		// On a cylinder or a plane epsilon alone cannot reach a target: one family stays at its bound.
		const double mean = std::sqrt(surfaceArea(minimum) / crossings) / realisedDistance;
		bounds.least      = std::min(bounds.least, std::max(mean / targetRange, median));
		bounds.most       = targetRange * mean;
	}
	if (options.minSpacing > 0.0)
		bounds.least = options.minSpacing;
	if (options.maxSpacing > 0.0)
		bounds.most = options.maxSpacing;
	bounds.least = std::max(bounds.least, smallestLeast * median);
	bounds.most  = std::max(bounds.most, bounds.least);
	return bounds;
}

} // namespace

double lineSpacing(double k, double eps, double minSpacing, double maxSpacing)
{
	const double radius = 1.0 / std::max(std::abs(k), 1e-300);
	const double e      = std::min(eps, radius);
	return std::clamp(2.0 * std::sqrt(e * (2.0 * radius - e)), minSpacing, maxSpacing);
}

LineSpacing chooseLineSpacing(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const LineSpacingOptions&   options,
	double                      crossings)
{
	const Eigen::Vector3d extent =
		cloud.positions.rowwise().maxCoeff() - cloud.positions.rowwise().minCoeff();
	const double diagonal = extent.norm();
	const Bounds bounds   = spacingBounds(minimum, options, diagonal, crossings);

	const GradedDistances graded(cloud, field, minimum, options.gradation);
	const auto            at = [&](double epsilon) {
        std::array<std::vector<double>, 2> distance;
        parallelFor(2, {}, [&](Index f) { distance[f] = graded(f, epsilon * diagonal, bounds); });
        return distance;
	};
	const auto predict = [&](double epsilon) { return predictedCrossings(minimum, at(epsilon)); };

	LineSpacing result;
	result.diagonal = diagonal;
	result.epsilon  = crossings > 0.0 ? epsilonFor(crossings, predict) : options.epsilon;
	result.distance = at(result.epsilon);
	return result;
}

} // namespace curvature_lines
