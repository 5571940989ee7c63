// Build Curvature-Aligned Quad Mesh: core/quad_mesh on the layer of lines.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "line_network.h"
#include "mesh_finishing.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "polygon_layer.h"
#include "polygon_mesh.h"
#include "polyline_layer.h"
#include "quad_mesh.h"
#include "shared_parameters.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

// Where the lines came from, if that layer is still there.
int defaultCloud(const MeshDocument& document)
{
	const MeshModel* current = document.mm();
	if (current == nullptr)
		return -1;
	const int source = sourceLayerOf(*current);
	return source >= 0 && document.getMesh(source) != nullptr ? source : current->id();
}

struct Options {
	int                  cloudLayer = -1;
	MeshFinishingOptions mesh;
};

void parameters(ParameterTable& table, Options& options)
{
	options.cloudLayer = defaultCloud(table.document());
	table.row(
		"point_cloud",
		options.cloudLayer,
		Layer{table.document()},
		"Point cloud",
		"The layer the lines were traced on. It is found by itself when the lines were traced in "
		"this session.");
	meshParameters(table, options.mesh);
	table.row(
		"split_concave",
		options.mesh.splitConcave,
		Flag(),
		"Split concave faces",
		"Cut faces with a reflex corner into convex ones.");
}

void requireLinesOnCloud(const LineNetwork& lines)
{
	// The cloud fills a box of diagonal 1 about the origin.
	if (lines.vertices.cwiseAbs().maxCoeff() > 1.0)
		throw MLException(
			"the lines do not lie on the point cloud; choose the layer they were traced on as "
			"'point_cloud'.");
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	const MeshModel& lineLayer  = currentLayer(context.document);
	const MeshModel* cloudLayer = context.document.getMesh(options.cloudLayer);
	if (sourceLayerOf(lineLayer) < 0 && lineLayer.cm.en == 0)
		throw MLException(
			"the current layer '" + lineLayer.label() +
			"' holds no lines. Run 'Trace Lines of Curvature' (generate_curvature_lines) on the "
			"point cloud first and leave its layer current.");
	if (cloudLayer == nullptr)
		throw MLException(
			"parameter 'point_cloud' is " + QString::number(options.cloudLayer) +
			", and there is no such layer; allowed is the layer the lines were traced on.");
	if (cloudLayer == &lineLayer)
		throw MLException(
			"parameter 'point_cloud' names the lines themselves; choose the layer they were traced "
			"on.");
	requireSameMatrix(lineLayer, *cloudLayer, "the lines and the point cloud");

	const LayerPoints   points = readOrientedPoints(*cloudLayer, context.progress);
	Stopwatch           total, stage;
	FilterResults       results;
	const PreparedCloud prepared = prepareCloud(points.positions, points.normals);
	const LineNetwork   lines    = readLines(lineLayer, prepared);
	requireLinesOnCloud(lines);
	const VoronoiCells cells(
		prepared.cloud.positions, context.progress.sub(0.0, 0.3, "Finding Voronoi cells"));
	results.seconds("voronoi", stage.lap());
	const QuadMeshResult built = buildQuadMesh(
		prepared.cloud,
		cells,
		lines,
		options.mesh,
		context.progress.sub(0.3, 1.0, "Building the mesh"));
	results.seconds("mesh", stage.lap());

	if (built.mesh.faceCount() == 0)
		throw MLException(
			"the lines enclose no face; trace more of them (smaller 'epsilon', or set "
			"'target_vertices').");

	NewLayers          layers(context.document);
	MeshModel&         layer    = layers.add("curvature-aligned mesh", lineLayer);
	const MeshTopology topology = writePolygons(layer, built, prepared);
	layers.keep(layer);

	results.count("lines", lines.lines());
	results.count("crossings", built.crossings);
	reportMesh(results, topology, built.texture);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec quadMeshFilter()
{
	return {
		"Build Curvature-Aligned Quad Mesh",
		"generate_curvature_aligned_quad_mesh",
		"Builds a quad-dominant mesh from a layer of curvature lines",
		"Builds the mesh between lines of curvature: its vertices are the crossings of the two "
		"families of lines, its edges run along the lines, and most of its faces are "
		"quadrilaterals."
		"<br><br><b>Input.</b> The current layer must hold lines of curvature, as <i>Trace Lines "
		"of Curvature</i> makes them; the "
		"point "
		"cloud they were traced on must still be there, unchanged."
		"<br><br><b>Writes</b> a new layer '<i>curvature-aligned mesh</i>' of polygons (in "
		"MeshLab: "
		"triangles whose inner edges are hidden) and makes it current. Save it as OBJ: PLY drops "
		"polygons. Every edge has at most two faces." +
			helpReference,
		FilterPlugin::Polygonal + FilterPlugin::Remeshing + FilterPlugin::MeshCreation,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_NONE,
		{parameters, apply}};
}

} // namespace curvature_lines
