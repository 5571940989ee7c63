// A bound for the moves of denoising: by the noise, so that a cloud without any comes back as it was.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"

namespace curvature_lines {

// `before`: 3 x N, searched by `search`; `deviation`: of the noise of every point, a length; `after`: 3 x N, where the points
// have moved. A move much farther than the noise has met shape narrower than the smallest patches, or another face or sheet:
// up to 4 deviations it stays, from 6 on it is taken back, in between in part. The noise of a place is also told by half of
// the moves around, as its estimate is too smooth for noise that changes within a few spacings.
void limitMoves(
	const Eigen::Matrix3Xd&    before,
	const NeighborSearch&      search,
	const std::vector<double>& deviation,
	Eigen::Matrix3Xd&          after);

} // namespace curvature_lines
