// Quads that are not convex or turned over, and that no move of vertices mends: two opposite corners become one, and the
// face is gone (the diagonal collapse of Tarini et al. 2010, who make quad meshes coarser by it). Two faces that share two edges become one.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// Only where the faces around get better and fewer of them are unsound; what is a quad stays one, V - E + F and rims stay.
// Corners on features (`onFeature`, of every vertex; follows the mesh) stay where they are, the other one goes there.
// Returns how many faces are gone. Vertices that are left keep their order.
Index collapseUnsoundQuads(std::vector<char>& onFeature, PolygonMesh& mesh);

} // namespace curvature_lines
