// From a scaffold to the faces between the lines of its position field: crosses, density, phases, arrangement, clean-up.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "closed_position_field.h"
#include "curvature_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "position_field.h"
#include "progress.h"
#include "rims.h"
#include "scaffold.h"
#include "singular_pairs.h"
#include "singular_vertices.h"
#include "size_feedback.h"
#include "surface_arrangement.h"
#include "surface_curves.h"

namespace curvature_lines {

struct FieldMeshingOptions {
	LineDensityOptions   density;
	PositionFieldOptions phases;
	// No line ends inside, so that faces are quads (ClosedPositionField), and singular points that noise has made go.
	bool   closed = true;
	double countTolerance =
		0.03; // relative, of the number of vertices: beyond, the density is corrected once
	// What the mesh leaves out gets smaller faces: at the cost of the others, or on top of the target.
	bool                holdTarget = true;
	ClosingOptions      closing;
	SingularPairOptions pairs;
};

struct MeshedField {
	SingularVertices   surface; // on which the curves are
	SurfaceCurves      curves;
	SurfaceArrangement arrangement; // its mesh cleaned up
	Index              singularTriangles = 0, lineEnds = 0;
	Index              turnedOver = 0; // triangles, ClosedPositionField::turnedOver
	Index   otherFaces = 0; // that were no quads before paths between them made them some
	LeftOut far;
	Index   droppedCreaseEdges = 0; // no line could be laid along them
};

// The mesh has about options.density.targetVertices: a first one tells how much its lines have to be denser, and which
// creases they cannot follow.
MeshedField meshOfField(
	Scaffold                   scaffold,
	const std::vector<Rim>&    rims,
	const CurvatureField&      curvature,
	const FieldMeshingOptions& options  = {},
	const Progress&            progress = {});

} // namespace curvature_lines
