// Crossings of the lines of curvature (A09 section 5.2), by exact predicates on normal strips.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "line_tracing.h"

namespace curvature_lines {

// One crossing: a vertex of the mesh, on one line of each family (or on two of the same, if they do
// cross).
struct LineCrossing {
	Eigen::Vector3d position, normal; // midpoint between the two lines, mean of their normals
	Index           line[2];          // the two lines; may be the same one twice
	double          parameter[2]; // position along each: vertex index + fraction, in [0, segments)
	Eigen::Vector3d tangent[2];   // unit direction of each line there
	int             side;         // +1: line[1] goes over to the left of line[0], -1: to its right
};

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

// Mean distance from a site to its six nearest neighbours: the spacing of the cloud there.
double siteSpacing(const VoronoiCells& cells, Index site);

Index segmentCount(const LineNetwork& lines, Index line);
bool  isClosed(const LineNetwork& lines, Index line); // marked so, and long enough to be

// Point of a polyline at a parameter.
Eigen::Vector3d pointOnLine(const LineNetwork& lines, Index line, double parameter);

} // namespace curvature_lines
