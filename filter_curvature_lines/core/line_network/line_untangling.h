// Polylines of one family that cross each other, or themselves, cut until none does.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "line_network.h"

namespace curvature_lines {

// For lines from a scaffold that is folded over, as a few triangles at noisy rims are. A line that crosses
// itself loses the loop between, and of two lines that cross one ends before the crossing (LineEnd::Line);
// whatever takes the fewest vertices. Crossings are those in the tangent planes of the vertices; segments
// of different faces have none.
LineNetwork untangled(const LineNetwork& lines);

} // namespace curvature_lines
