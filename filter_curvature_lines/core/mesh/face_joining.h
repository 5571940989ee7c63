// Two faces with a common edge that become quads without it. Internal to quad_completion.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <vector>

#include "linked_faces.h"
#include "point_cloud.h"

namespace curvature_lines {

struct JoinedFaces {
	std::vector<LinkedFaces::Loop> quads;                  // empty: there is no way
	double cost = std::numeric_limits<double>::infinity(); // quad_patterns.h
};

// The faces on both sides of an edge, of four or six corners together, as one or two convex quads without that edge; the
// cheapest way. Every inner vertex keeps three edges, no two vertices get a second edge, and features stay.
JoinedFaces joinedFaces(const LinkedFaces& faces, Index side);

} // namespace curvature_lines
