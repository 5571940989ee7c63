// The arrangement of the lines: a half-edge graph of their crossings (A09 section 6), with the
// paper's "other lines that meet at an existing intersection" as one vertex.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "half_edge_graph.h"
#include "line_intersections.h"
#include "line_network.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct LineArrangement {
	HalfEdgeGraph graph; // reduced, no two edges between the same vertices
	Index merged = 0;    // crossings joined to another because three lines pass too close together
};

// Pairs of lines cross consistently, but where three pass within the height of one above the other,
// the order of their crossings may fit no surface. A loop that turns more than once shows it
// (Gauss-Bonnet); its closest crossings become one vertex, with the lines sorted around it by where
// they leave, until every loop turns once.
LineArrangement
arrangeLines(const VoronoiCells& cells, const LineNetwork& lines, const LineIntersections& found);

} // namespace curvature_lines
