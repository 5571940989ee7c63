// How far apart lines of curvature of one family run (A09 section 5.1, d(kappa)), at every point of the
// cloud, and the epsilon that gives a wanted number of crossings.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "line_tracing.h"

namespace curvature_lines {

struct LineSpacing {
	double                             diagonal = 0.0; // of the cloud's bounding box
	double                             epsilon  = 0.0; // fraction of it
	std::array<std::vector<double>, 2> distance; // N per family: distance to keep from the next line
};

// `crossings` > 0: epsilon is found for about so many, and the automatic bounds give way if they have to;
// otherwise options.epsilon is taken.
LineSpacing chooseLineSpacing(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const LineTracingOptions&   options,
	double                      crossings);

} // namespace curvature_lines
