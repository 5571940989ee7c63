// How far apart lines of curvature of one family run (A09 section 5.1, d(kappa)), at every point of the
// cloud, and the epsilon that gives a wanted number of crossings.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

struct LineSpacingOptions {
	// chord error, fraction of the bounding-box diagonal (A09 prints it as kappa)
	double epsilon    = 1e-5;
	double minSpacing = 0.0; // length; 0 = automatic, a multiple of the median point spacing
	double maxSpacing = 0.0; // length; 0 = automatic
	// d grows by no more than this times the distance. With 0.25 a small detail makes lines dense all around:
	// on a cow crossings fall 5 instead of 10 times when epsilon grows tenfold (7 with 1), but a mesh has
	// more quads.
	double gradation = 1.0;
};

struct LineSpacing {
	double diagonal = 0.0; // of the cloud's bounding box
	double epsilon  = 0.0; // fraction of it
	// N per family: distance to keep from the next line
	std::array<std::vector<double>, 2> distance;
};

// Distance to keep from the next line of the same family: 2 sqrt(eps (2/|k| - eps)), the chord of sagitta
// eps, clamped to [minSpacing, maxSpacing]. k is the curvature *across* the line. All in the same length unit.
double lineSpacing(double k, double eps, double minSpacing, double maxSpacing);

// `crossings` > 0: epsilon is found for about so many, and the automatic bounds give way if they have to;
// otherwise options.epsilon is taken.
LineSpacing chooseLineSpacing(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const LineSpacingOptions&   options,
	double                      crossings);

} // namespace curvature_lines
