// Lines of curvature as a layer of vertices and edges, and back; sharp features likewise. Hosts give edges no data of their
// own, so what belongs to a line is stored on its vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/ml_document/mesh_document.h>

#include "crease_curves.h"
#include "creases.h"
#include "line_network.h"
#include "line_tracing.h"
#include "point_cloud.h"

namespace curvature_lines {

// Fills an empty layer. `sourceLayer` is the id of the cloud the lines were traced on.
void writeLines(
	MeshModel& layer, const LineNetwork& lines, const PreparedCloud& frame, int sourceLayer);

// Fills an empty layer with a vertex per line at the corners it ends in.
void writeCreases(MeshModel& layer, const Creases& creases, const PreparedCloud& frame);

// Lines in the unit frame of their cloud. Throws when the layer holds no lines of curvature.
LineNetwork readLines(const MeshModel& layer, const PreparedCloud& frame);

// Id of the cloud the lines were traced on, -1 when unknown. Never throws.
int sourceLayerOf(const MeshModel& layer);

} // namespace curvature_lines
