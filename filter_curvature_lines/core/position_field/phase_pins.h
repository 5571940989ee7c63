// Where the phases of a position field are held: rims and creases that are lines of the mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// Vertices where a phase is an integer, because they lie on a rim or crease along the other arm.
struct PhasePins {
	std::array<std::vector<char>, 2> fixed; // per family and vertex
	std::vector<char> crease; // per edge: between pinned vertices lines run along it; empty: none

	explicit PhasePins(Index vertices = 0) :
			fixed{std::vector<char>(vertices, 0), std::vector<char>(vertices, 0)}
	{
	}
};

} // namespace curvature_lines
