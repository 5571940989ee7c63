// Quads that are turned over or not convex, and that no move of vertices mends: the faces around them are joined in another way.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

// Of the edits near each bad face (QuadEdits), untangled each (untangleFaces()), the best one is kept if fewer faces are bad
// after it, or less so. What is a quad stays one, V - E + F and rims stay; vertices on features (`onFeature`, of every vertex;
// follows the mesh) stay where they are. Returns how many unsound faces are left, as untangleFaces() counts them.
Index repairQuads(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	std::vector<char>&    onFeature,
	PolygonMesh&          mesh,
	const Progress&       progress = {});

} // namespace curvature_lines
