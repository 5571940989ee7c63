// The curvature-aligned quad-dominant mesh from traced lines: faces between lines of curvature (A09 section 6).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "line_network.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "progress.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct QuadMeshResult : FinishedMesh {
	// of the crossings, joined to another where three lines pass too close together
	Index mergedCrossings = 0;
	Index discardedLoops  = 0; // around holes, along rims, and tangled ones
	Index tangledLoops = 0; // of these, that bound no disk: the mesh has a hole the cloud has not
	Index islands      = 0; // components inside a face of another one, left out
};

// Two-manifold with boundary by construction: each half-edge bounds at most one face, no two edges
// join the same vertices, no face visits a vertex twice, and vertices where several fans meet are
// split.
QuadMeshResult buildQuadMesh(
	const PointCloud&           cloud,
	const VoronoiCells&         cells,
	const LineNetwork&          lines,
	const MeshFinishingOptions& options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
