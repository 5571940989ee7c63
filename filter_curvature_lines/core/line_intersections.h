// Crossings of the two families of lines, cell by cell (A09 section 5.2). Whether two lines cross in a
// cell is decided combinatorially, by whether their wall points interleave around the cell; geometry only
// places the vertex. So no crossing is lost or counted twice at a wall.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "line_tracing.h"

namespace curvature_lines {

// One crossing: a vertex of the mesh, on one line of each family (or on two of the same, if they do cross).
struct LineCrossing {
	Eigen::Vector3d position, normal;
	Index  line[2];      // the two lines
	double parameter[2]; // position along each: vertex index + fraction, in [0, number of segments)
};

struct LineIntersections {
	std::vector<LineCrossing> crossings;
	std::vector<std::vector<Index>> alongLine; // per line: crossing ids by increasing parameter
	Index dangling = 0; // line pieces beyond the last crossing, left out
};

LineIntersections intersectLines(
	const PointCloud&   cloud,
	const VoronoiCells& cells,
	const LineNetwork&  lines,
	const Progress&     progress = {});

} // namespace curvature_lines
