// Crossings of the lines of curvature (A09 section 5.2), by exact predicates on normal strips.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "line_crossing.h"
#include "line_network.h"
#include "point_cloud.h"
#include "progress.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct LineIntersections {
	std::vector<LineCrossing> crossings;
	// Per line: its crossings by increasing parameter, as 2 * crossing + slot, where slot tells
	// which of the crossing's two lines it is.
	std::vector<std::vector<Index>> alongLine;
	Index                           dangling = 0; // line pieces beyond the last crossing, left out
	Index cancelled = 0; // crossings of pairs that touch and part again within a strip's height
	Index reordered = 0; // neighbours along a line exchanged so that three lines fit on a surface
};

// The lines do not meet in space, so the paper projects both to a tangent plane per Voronoi cell, which
// loses or doubles crossings at the walls, and no rule on walls holds where 3-D cells form slivers. Here a
// line crosses another where its polyline pierces the other's normal strip: the ruled band swept by the
// normals along it. The band is one connected surface and the orientation predicates are exact, so whether
// lines cross is decided once and consistently across every joint; geometry only places the vertex.
LineIntersections
intersectLines(const VoronoiCells& cells, const LineNetwork& lines, const Progress& progress = {});

} // namespace curvature_lines
