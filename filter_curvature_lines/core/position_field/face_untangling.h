// Faces that are turned over or not convex, mended by moving their vertices along the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// Vertices that are `fixed` stay, as do all whose faces are sound. A vertex moves only if the worst of the faces around it
// gets better. Returns how many unsound faces are left.
Index untangleFaces(
	const CloudIndex&        index,
	const CurvatureField&    curvature,
	const std::vector<char>& fixed,
	PolygonMesh&             mesh);

} // namespace curvature_lines
