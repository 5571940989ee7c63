// Lines from edges in any order: what files and hosts keep of them.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// The vertices along each line. An open line starts at its end of lower index, a closed one at its lowest vertex towards
// the lower neighbour. Lines come in the order of their first vertices.
struct LineChains {
	std::vector<std::vector<Index>> vertices;
	std::vector<char>               closed; // per line

	Index size() const { return static_cast<Index>(vertices.size()); }
};

// Nothing when lines branch: when more than two edges meet in a vertex. Vertices without an edge are in no line.
std::optional<LineChains>
chainEdges(Index vertexCount, const std::vector<std::array<Index, 2>>& edges);

} // namespace curvature_lines
