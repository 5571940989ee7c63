// The curvature-aligned quad mesh from a position field: scaffold, crosses, line density, phases,
// arrangement, clean-up, and projection of the vertices onto the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "curvature_field.h"
#include "line_network.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "position_field.h"
#include "progress.h"
#include "scaffold.h"
#include "scaffold_sites.h"

namespace curvature_lines {

struct PositionFieldMeshOptions {
	double          targetVertices = 1600.0;
	bool            automatic      = false; // SizingOptions::automatic
	double          anisotropy = 1.5; // largest ratio of spacings that curvature asks for; 1: none
	double          noise      = 0.0; // left in the cloud, a length
	ScaffoldOptions scaffold;         // its noise and closed rims are set from the others
	PositionFieldOptions phases;
	MeshFinishingOptions mesh;
	bool                 keepLines = false; // as polylines, beside the mesh

	PositionFieldMeshOptions() { mesh.quads = QuadKind::Pure; }
};

struct PositionFieldMeshResult : FinishedMesh {
	Index scaffoldVertices = 0, scaffoldEuler = 0;
	Index singularTriangles = 0, lineEnds = 0;
	Index turnedOver = 0, otherFaces = 0; // MeshedField: places that were made quads after the fact
	Index droppedComponents  = 0;         // too small for a mesh, or without any line
	Index repairedComponents = 0;
	Index filledHoles = 0, lostCreaseEdges = 0;
	Index unsoundFaces = 0; // not convex, or turned over, as far as untangleFaces() knows
	// That the sizes ask for; more than the target where limbs need more
	double      expectedVertices = 0.0;
	Index       caps             = 0; // faces that went on to the tip of a part no line crosses
	LineNetwork lines;                // if keepLines
};

// The cloud's normals are those of the surface. Points that keep their noise are put on the surfaces fitted
// around them, if the field knows their heights; else the cloud is clean.
PositionFieldMeshResult buildPositionFieldMesh(
	const CloudIndex&               index,
	const CurvatureField&           curvature,
	const std::vector<FeatureLine>& creases  = {},
	const PositionFieldMeshOptions& options  = {},
	const Progress&                 progress = {});

} // namespace curvature_lines
