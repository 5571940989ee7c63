// Radii from the number of points they hold, and quadrics in balls of these radii.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "anchor_fits.h"
#include "local_surface.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// By the experiments that adaptive_scale.cpp tells of. Radii go from the ball that holds firstCount points
// (smallestCount in a tiny cloud), the median over countedRadii points, up to a share of the bounding-box diagonal.
constexpr Index  firstCount    = 42;
constexpr Index  smallestCount = 14;
constexpr Index  countedRadii  = 60;
constexpr double largestRadius = 0.22; // unit frame
// Clouds of which a share of denseShare is denser than the rest get finer levels, mostFiner at most.
constexpr double denseShare = 0.1;
constexpr double mostFiner  = 12.0;
// The residual of quadrics is a quantile over so many places.
constexpr Index residualPlaces = 256;

std::vector<double> radiiHolding(const PointSample& sample, Index count)
{
	std::vector<double> radii;
	radii.reserve(countedRadii);
	for (Index i = 0; i < std::min<Index>(sample.cloud.size(), countedRadii); ++i) {
		const Eigen::Vector3d position = sample.cloud.positions.col(i);
		const auto            near     = sample.search.nearest(position, count);
		radii.push_back((sample.cloud.positions.col(near.back()) - position).norm());
	}
	return radii;
}

} // namespace

double ScaleLadder::middleRadius() const
{
	return std::sqrt(usualRadius * largestRadius);
}

ScaleLadder scaleLadder(const PointSample& sample)
{
	const std::vector<double> radii =
		radiiHolding(sample, std::clamp<Index>(sample.cloud.size() / 4, smallestCount, firstCount));
	ScaleLadder ladder;
	ladder.usualRadius = quantile(radii, 0.5);
	const double finer = std::min(
		mostFiner,
		std::floor(
			std::log(ladder.usualRadius / quantile(radii, denseShare)) / std::log(ladderStep)));
	ladder.smallestRadius =
		finer > 1.0 ? ladder.usualRadius * std::pow(ladderStep, -finer) : ladder.usualRadius;
	ladder.levels = std::max(
		1, 1 + int(std::log(largestRadius / ladder.smallestRadius) / std::log(ladderStep)));
	return ladder;
}

double quadricResidual(const PointSample& sample, const ScaleLadder& ladder)
{
	double noise = infinity;
	for (int level = 0; level < ladder.levels; ++level) {
		const HeightScale   scale{ladder.radius(level), 2};
		const PointSubsets  subsets(sample, scale.radius);
		std::vector<double> residuals(std::min<Index>(sample.cloud.size(), residualPlaces));
		parallelFor(static_cast<Index>(residuals.size()), {}, [&](Index p) {
			const SurfaceElement element = surfaceAt(
				subsets,
				p,
				sample.cloud.positions.col(p),
				sample.cloud.normals.col(p),
				scale,
				probeIterations);
			residuals[p] = element.valid ? element.residual : infinity;
		});
		const double residual = quantileInPlace(residuals, smoothShare);
		noise                 = std::min(noise, residual);
		if (residual < clippedResidual * scale.radius)
			return residual;
	}
	return noise < infinity ? noise : 0.0;
}

} // namespace curvature_lines
