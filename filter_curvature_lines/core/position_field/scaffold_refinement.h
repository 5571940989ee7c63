// A finer scaffold where its triangles are too coarse for the surface between its vertices, as around thin limbs.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "point_cloud.h"
#include "scaffold.h"

namespace curvature_lines {

// Splits edges along which the normal turns far, rims and creases excepted: there the lines of a mesh would have no surface
// to run on. New vertices are on the curved triangle that the normals of its corners describe (PN triangles, Vlachos et
// al. 2001); they have no source. Returns how many there are.
Index refineBends(Scaffold& scaffold);

} // namespace curvature_lines
