// The lines on which a phase of a position field is a whole number, as polylines: the same shape as traced
// ones.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "line_network.h"
#include "scaffold.h"
#include "surface_curves.h"

namespace curvature_lines {

// Vertices are the points of `curves` on the edges of the scaffold, projected onto the surface; those on
// rims and creases stay where the mesh has them. The crosses of the field do not distinguish the families,
// around a singular point they change places. The principal directions do: where a curve goes over from one
// to the other it is cut, and both parts have a vertex there and an end of kind Umbilic. So lines of one
// family do not cross, but where the scaffold is folded over; there they end (untangled()). Rims and
// creases, which the mesh has as lines too, are not among them.
LineNetwork linesOf(
	const SurfaceCurves&  curves,
	const Scaffold&       scaffold,
	const CrossField&     field,
	const CloudIndex&     index,
	const CurvatureField& curvature);

} // namespace curvature_lines
