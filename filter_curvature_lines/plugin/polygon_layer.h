// Polygon meshes as MeshLab holds them: triangles whose inner edges are faux on both sides.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/ml_document/mesh_document.h>

#include "filter_results.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "texture_charts.h"

namespace curvature_lines {

// Fills an empty layer, with wedge texture coordinates where the mesh has some, and returns what it then is.
MeshTopology
writePolygons(MeshModel& layer, const FinishedMesh& finished, const PreparedCloud& frame);

// The counts that filters return which end in a mesh; of the texture only if it was asked for.
void reportMesh(
	FilterResults& results, const MeshTopology& topology, const TextureCoordinates& texture);

} // namespace curvature_lines
