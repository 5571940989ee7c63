// Crossings of noisy lines made consistent with each other, without geometry.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "line_crossing.h"
#include "line_network.h"
#include "point_cloud.h"

namespace curvature_lines {

// Ids of the crossings along each line, as in LineIntersections::alongLine.
std::vector<std::vector<Index>>
sortAlongLines(const LineNetwork& lines, const std::vector<LineCrossing>& crossings);

// Corrections at crossings that are closer along their lines than reach[line vertex], repeated while they
// find something. None changes V - E + F of lines that lie in a surface.
// - A line that crosses itself within that distance does so by noise: that crossing goes.
// - Two lines that cross and cross back at once bound an empty digon: both crossings go.
// - Three lines that cross pairwise bound a triangle. The opposite corner lies on one side of each line,
//   whichever of the two others leads there; where the two answers differ for exactly one line, the two
//   crossings on it are in the wrong order, and they are exchanged.
// Returns the number of exchanges.
Index makeConsistent(
	const LineNetwork&         lines,
	const std::vector<double>& reach,
	std::vector<LineCrossing>& crossings);

} // namespace curvature_lines
