// What outlier rejection says of every point of a cloud.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

struct OutlierResult {
	std::vector<char>   outlier;        // N, 1 = rejected
	std::vector<double> score;          // N, share of votes against, 0..1; 1 for isolated points
	Index               isolated   = 0; // rejected because nothing surrounds them
	Index               roundsUsed = 0;
	double              noise      = 0.0; // robust standard deviation of height residuals (length)
};

} // namespace curvature_lines
