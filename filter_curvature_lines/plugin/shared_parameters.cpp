// Parameters that several filters have.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared_parameters.h"

#include "curvature_cache.h"
#include "curvature_estimate.h"
#include "mesh_finishing.h"
#include "parameter_table.h"
#include "robust_curvature.h"
#include "umbilics.h"

namespace curvature_lines {

void scaleModeParameter(ParameterTable& table, ScaleMode& mode, bool advanced)
{
	table.row(
		"scale_mode",
		mode,
		Choice{{"Adaptive", "Paper"}},
		"Scale",
		"How large the region is that each estimate looks at.<ul>"
		"<li><b>Adaptive</b>: found from the cloud, around every point: as large as the noise asks "
		"for and as small as the shape does</li>"
		"<li><b>Paper</b>: a fixed number of local point spacings, as published</li></ul>",
		advanced);
}

void estimateParameters(ParameterTable& table, EstimateOptions& options)
{
	RobustCurvatureOptions& paper = options.curvature.paper;
	scaleModeParameter(table, options.curvature.scaleMode, false);
	table.row(
		"region_scale",
		paper.regionScale,
		Real{1.0, 20.0},
		"Region scale (Paper; spacings)",
		"With Scale Paper only: radius of the operating region around each point, in local point "
		"spacings (1 to 20). Larger regions resist more noise and blur more detail.");
	table.row(
		"max_iterations",
		paper.maxIterations,
		Integer{1, 1000},
		"Maximum iterations (Paper)",
		"With Scale Paper only: largest number of reweighting iterations per point (1 to 1000).",
		advancedParameter);
	table.row(
		"feature_gate",
		paper.featureGate,
		Flag(),
		"Feature gate (Paper)",
		"With Scale Paper only: keep only neighbours that agree with the point itself before the "
		"fit, so that the other side of a sharp edge has no influence.",
		advancedParameter);
	table.row(
		"boundary_threshold",
		options.neighborhood.boundaryThreshold,
		Real{1.0, 100.0},
		"Boundary threshold (spacings)",
		"A sixth of the tangent plane counts as empty when its closest point is farther than this "
		"many median point spacings (1 to 100); two neighbouring empty sixths make a boundary "
		"point.",
		advancedParameter);
}

void umbilicParameter(ParameterTable& table, UmbilicOptions& options)
{
	table.row(
		"umbilic_ratio",
		options.ratio,
		Real{0.0, 1.0},
		"Umbilic ratio (0 to 1)",
		"A point is umbilic, without principal directions of its own, when the smaller curvature "
		"is more than this share of the larger one (0 to 1).",
		advancedParameter);
}

void meshParameters(ParameterTable& table, MeshFinishingOptions& options)
{
	table.row(
		"quads",
		options.quads,
		Choice{{"Pure", "Dominant", "Subdivided"}},
		"Quads",
		"Which faces the mesh has.<ul>"
		"<li><b>Pure</b>: quads only, with few irregular vertices</li>"
		"<li><b>Dominant</b>: quads, and triangles and pentagons where lines end, which follow the "
		"directions most "
		"closely</li>"
		"<li><b>Subdivided</b>: quads only, from a coarser mesh, each of whose faces is divided "
		"from its centre</li></ul>");
	table.row(
		"triangulate",
		options.triangulate,
		Flag(),
		"Triangulate",
		"Cut all faces into triangles, for programs that know no others.");
	table.row(
		"close_holes",
		options.closeHoles,
		Flag(),
		"Close holes",
		"Fill holes that are small against the mesh.");
	table.row(
		"texture_coordinates",
		options.textureCoordinates,
		Flag(),
		"Texture coordinates",
		"Give the corners of the faces texture coordinates (of wedges, between 0 and 1) along the "
		"two families of lines: every quad is a square cell, all cells are equally large, and "
		"'texture_cells' of them fill a side of the texture. The mesh is cut into "
		"'texture_charts' pieces that do not overlap, with seams at sharp creases (Position "
		"Field) and from irregular vertices on; other faces than quads fill a cell each. Save the "
		"mesh as PLY, or with Triangulate as OBJ: hosts write wrong texture coordinates into OBJ "
		"files of polygons.");
}

} // namespace curvature_lines
