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
	// Of the points, 0..1: on no surface (unstructured_points.h). Those rejected as such, or, where that was not asked for,
	// of a sample.
	double unstructuredShare = 0.0;
	// Robust standard deviation of the heights of points over the voters' quadrics (1.4826 median |r|, corrected
	// for what the fit takes of it), the median over the voters; a length. It contains whatever detail a
	// quadric of 24 to 400 points does not follow.
	double heightDeviation = 0.0;
};

} // namespace curvature_lines
