// Polygon meshes as MeshLab holds them: triangles whose inner edges are faux on both sides.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/ml_document/mesh_document.h>

#include "filter_results.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// Fills an empty layer and returns what it then is.
MeshTopology
writePolygons(MeshModel& layer, const PolygonMesh& polygons, const PreparedCloud& frame);

// The counts that filters return which end in a mesh.
void reportMesh(FilterResults& results, const MeshTopology& topology);

} // namespace curvature_lines
