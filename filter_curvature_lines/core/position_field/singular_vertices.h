// Singular triangles of a closed position field get a vertex where their fixed point is, so that its lines can end there.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cross_field.h"
#include "position_field.h"
#include "scaffold.h"
#include "surface_graph.h"

namespace curvature_lines {

struct SingularVertices {
	Scaffold scaffold;
	// The new vertices have no frame: edges to them have no turns, and the phase at their end is the one of the fixed
	// point in the frame at their start. No triangle is singular.
	CrossField        field;
	PositionField     positions; // phase and end
	SurfaceFeatures   features;
	std::vector<char> singular; // of every vertex; the new ones come last
};

SingularVertices splitSingularTriangles(
	const Scaffold&        scaffold,
	const CrossField&      field,
	const PositionField&   positions,
	const SurfaceFeatures& features);

} // namespace curvature_lines
