// Lines of curvature traced on the cloud in order of confidence (A09 section 5.1; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "curvature_field.h"
#include "line_network.h"
#include "line_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "surface_projection.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct LineTracingOptions : LineSpacingOptions {
	Index  targetVertices     = 0; // > 0: epsilon is chosen so that about so many crossings result
	double tolerance          = 0.01; // tau of the adaptive step
	ProjectionKind projection = ProjectionKind::Mixed;
	// Lines start at distance d or more from the next of their family, and end below this times d. The papers
	// have 1: every gap narrower than 2 d ends a line. Measured on a torus: of all gaps 97 % are within .7 d
	// and 2 d with .7, 88 % with .5; quads of the mesh 96 and 99 %, as fewer lines end.
	double stopFactor = 0.7;
};

// Of lines that are wanted for the mesh between them: fewer ends, instead of exact distances.
constexpr double meshStopFactor = 0.5, meshGradation = 0.25;

LineNetwork traceLines(
	const PointCloud& cloud,
	// directions as they should be followed (smoothed or not)
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const LineTracingOptions&   options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
