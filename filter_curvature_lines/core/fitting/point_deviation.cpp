// Quantiles of the residual variances of patches around a sample of the points, spread over all.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_deviation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "blended_surface.h"
#include "local_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

// By experiment on clouds whose noise and density vary tenfold (benchmarks/cleaning.py).
constexpr Index  places         = 500;   // at which the deviation is measured
constexpr Index  averagedPlaces = 8;     // around a point, whose geometric mean is its deviation
constexpr Index  fewestPatches  = 300;   // around a place, whose quantile is its deviation,
constexpr double leastShare     = 0.04;  // or this share of all patches
constexpr double minDeviation   = 1e-10; // a length: of exact samples
constexpr Index  fewPoints      = 1000;  // of a cloud in which few patches lie off the edges

// A lower quantile, and how many standard deviations it is below the mean of a normal distribution.
struct Quantile {
	double share, below;
};
// A patch needs twenty points: in a small cloud it is half as wide as a part of it, and few lie off the edges.
constexpr Quantile quartile = {0.25, 0.6744898}, tenth = {0.1, 1.2815516};

} // namespace

// Noise varies over a cloud. The lower quantile of many patches belongs to those off the edges; chi-squared
// quantile by Wilson and Hilferty.
std::vector<double>
pointDeviation(const BlendedSurface& blend, const PointCloud& cloud, const SpatialOrder& order)
{
	if (blend.center.empty())
		return std::vector<double>(cloud.size(), minDeviation);
	const double             degrees  = std::max(1.0, quantile(blend.effectiveCount, 0.5) - 6.0);
	const double             scatter  = 2.0 / (9.0 * degrees);
	const auto               low      = cloud.size() < fewPoints ? tenth : quartile;
	const double             expected = std::pow(1.0 - scatter - low.below * std::sqrt(scatter), 3);
	const Eigen::Matrix3Xd   centers  = columnsOf(cloud.positions, blend.center);
	const NeighborSearch     search(centers);
	const std::vector<Index> at = order.sample(places);
	const Index              count =
		std::max(fewestPatches, static_cast<Index>(leastShare * double(blend.center.size())));
	std::vector<double> deviation(at.size());
	parallelFor(static_cast<Index>(at.size()), {}, [&](Index k) {
		std::vector<double> variance;
		for (const Index c : search.nearest(cloud.positions.col(at[k]), count))
			variance.push_back(blend.variance[c]);
		deviation[k] =
			std::max(minDeviation, std::sqrt(quantileInPlace(variance, low.share) / expected));
	});
	return spreadOver(cloud.positions, at, deviation, averagedPlaces, {});
}

} // namespace curvature_lines
