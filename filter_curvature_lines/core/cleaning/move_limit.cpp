// Moves against the noise of their place.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "move_limit.h"

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "robust_kernel.h"

namespace curvature_lines {

namespace {

// The noise moves one point in 16 000 by more than wholeMove deviations. By experiment on the shapes of a public denoising
// set and on fillets: on exact CAD parts of 50 000 points a quarter of the error is left that moves of ten deviations and a
// twentieth of a spacing made.
constexpr double wholeMove      = 4.0;
constexpr double noMove         = 6.0;
constexpr Index  movesAround    = 48;
constexpr double mostOfEstimate = 2.5; // of the deviation that the moves around tell

} // namespace

void limitMoves(
	const Eigen::Matrix3Xd&    before,
	const NeighborSearch&      search,
	const std::vector<double>& deviation,
	Eigen::Matrix3Xd&          after)
{
	const Eigen::Matrix3Xd moves     = after - before;
	const Eigen::VectorXd  distances = moves.colwise().norm();
	parallelFor(static_cast<Index>(before.cols()), {}, [&](Index i) {
		if (distances[i] <= wholeMove * deviation[i])
			return;
		std::vector<double> around;
		for (const Index j : search.nearest(before.col(i), movesAround))
			around.push_back(distances[j]);
		const double here = std::clamp(
			deviationOverMedian * medianInPlace(around),
			deviation[i],
			mostOfEstimate * deviation[i]);
		const double share = (noMove - distances[i] / here) / (noMove - wholeMove);
		after.col(i)       = before.col(i) + std::clamp(share, 0.0, 1.0) * moves.col(i);
	});
}

} // namespace curvature_lines
