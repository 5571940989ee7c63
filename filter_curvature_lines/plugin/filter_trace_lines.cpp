// Trace Lines of Curvature: core/line_tracing on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "curvature_cache.h"
#include "curvature_field.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "line_network.h"
#include "line_tracing.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "polyline_layer.h"
#include "progress.h"
#include "shared_parameters.h"
#include "stages.h"
#include "umbilics.h"

namespace curvature_lines {

namespace {

enum class Method { TracedLines, PositionField };

struct Options {
	Method             method = Method::TracedLines;
	LineTracingOptions tracing; // spacings in model units
	UmbilicOptions     umbilics;
	bool               smoothDirections = true;
};

void parameters(ParameterTable& table, Options& options)
{
	LineTracingOptions& tracing = options.tracing;
	table.row(
		"method",
		options.method,
		Choice{{"Traced Lines", "Position Field"}},
		"Method",
		"<ul><li><b>Traced Lines</b>: one line after the other follows the directions, as "
		"published; they are where "
		"the lines of curvature are</li>"
		"<li><b>Position Field</b>: the lines of the mesh that Surface Reconstruction makes, all "
		"at once and "
		"evenly spaced; clean the cloud first. The parameters below do not concern it, except "
		"epsilon and "
		"the target number</li></ul>");
	table.row(
		"epsilon",
		tracing.epsilon,
		Real{1e-9, 0.5},
		"Chord error (of diagonal)",
		"Sets the density of the lines: neighbouring lines are as far apart as a chord that leaves "
		"the surface by this fraction of the bounding-box diagonal (1e-9 to 0.5).");
	table.row(
		"target_vertices",
		tracing.targetVertices,
		Integer{0, 10000000},
		"Target number of crossings (0: none)",
		"If not 0, the chord error is found so that the lines cross in about so many points: the "
		"vertices of the mesh to come (at most 10000000).");
	table.row(
		"min_spacing",
		tracing.minSpacing,
		Length(),
		"Minimum spacing (length; 0: automatic)",
		"Lines of one family are never closer than this, in the layer's units; 0 = automatic, from "
		"the point spacing.");
	table.row(
		"max_spacing",
		tracing.maxSpacing,
		Length(),
		"Maximum spacing (length; 0: automatic)",
		"The distance between lines where the surface is flat, in the layer's units; 0 = "
		"automatic.");
	table.row(
		"tolerance",
		tracing.tolerance,
		Real{1e-6, 1.0},
		"Step tolerance (relative)",
		"Relative error per step; smaller values trace in smaller steps (1e-6 to 1).",
		advancedParameter);
	table.row(
		"projection",
		tracing.projection,
		Choice{{"Mixed", "Locally Optimal", "Weighted Average"}},
		"Projection",
		"How line points are kept on the surface.<ul>"
		"<li><b>Mixed</b>: mean of point average and tangent planes, whose errors cancel</li>"
		"<li><b>Locally Optimal</b>: as published in 2009</li>"
		"<li><b>Weighted Average</b>: as published in 2007</li></ul>",
		advancedParameter);
	table.row(
		"stop_factor",
		tracing.stopFactor,
		Real{0.1, 1.0},
		"Stop factor",
		"A line ends where it comes closer to the next one than this times the distance new lines "
		"keep "
		"(0.1 to 1). Small values let lines run on through narrow places: gaps are less even, and "
		"the mesh "
		"between the lines has more quads (0.5: about 99 %).",
		advancedParameter);
	umbilicParameter(table, options.umbilics);
	table.row(
		"smooth_directions",
		options.smoothDirections,
		Flag(),
		"Smooth the directions",
		"Smooth the principal directions first, unless those on the layer are smoothed already. "
		"The "
		"layer keeps its own.");
}

LineTracingOptions tracingOptions(const LineTracingOptions& given, double diagonal)
{
	LineTracingOptions options = given;
	options.minSpacing /= diagonal;
	options.maxSpacing /= diagonal;
	if (options.maxSpacing > 0.0 && options.maxSpacing < options.minSpacing)
		throw MLException(
			"parameter 'max_spacing' is smaller than 'min_spacing'; raise it, or set it to 0 "
			"(automatic).");
	if (options.targetVertices > 0) // of a mesh
		options.gradation = meshGradation;
	return options;
}

// The lines of the default mesh of the cloud as it is.
LineNetwork positionFieldLines(
	const CurvatureEstimate&  estimate,
	const CurvatureField&     field,
	const LineTracingOptions& tracing,
	const Progress&           progress)
{
	FieldMeshOptions options;
	options.tracing   = tracing;
	options.keepLines = true;
	StageClock clock;
	return meshOfPositionField(adoptEstimate(estimate.index, field), options, clock, progress)
	    .mesh.lines;
}

FilterResults apply(const FilterContext& context, const Options& given)
{
	tracingOptions(given.tracing, 1.0); // complain before the long part
	UmbilicOptions umbilicOptions = given.umbilics;
	umbilicOptions.smoothed       = given.smoothDirections;

	MeshModel&        cloudLayer = currentLayer(context.document);
	const LayerPoints points     = readOrientedPoints(cloudLayer, context.progress);
	Stopwatch         total, stage;
	FilterResults     results;
	LayerCurvature    curvature =
		context.cache.ofLayer(cloudLayer, points, context.progress.sub(0.0, 0.3, ""));
	const CurvatureEstimate& estimate = *curvature.estimate;
	const PointCloud&        cloud    = estimate.prepared.cloud;
	results.seconds("curvature", stage.lap());

	const LineTracingOptions tracing  = tracingOptions(given.tracing, estimate.prepared.diagonal);
	const Progress           progress = context.progress.sub(0.3, 1.0, "Tracing lines");
	UmbilicRegions           umbilics;
	LineNetwork              lines;
	if (given.method == Method::PositionField) {
		umbilics = findUmbilics(cloud, *curvature.field, estimate.index.minimum(), umbilicOptions);
		results.seconds("umbilics", stage.lap());
		lines = positionFieldLines(estimate, *curvature.field, tracing, progress);
		results.seconds("tracing", stage.lap());
	}
	else {
		LineOptions options;
		options.smoothDirections = given.smoothDirections && !curvature.ownDirections;
		options.umbilics         = umbilicOptions;
		options.tracing          = tracing;
		StageClock  clock;
		TracedLines traced = followDirections(
			estimate.index.withNormals(cloud.normals), *curvature.field, options, clock, progress);
		umbilics = std::move(traced.umbilics);
		lines    = std::move(traced.lines);
		for (const auto& [name, seconds] : clock.seconds())
			results.seconds(name == "directions" ? "smoothing" : name, seconds);
	}
	if (lines.lines() == 0)
		throw MLException(
			"no line of curvature was found: the surface is flat or umbilic everywhere, or the "
			"spacing is larger than the cloud. A smaller 'max_spacing' may help.");

	NewLayers  layers(context.document);
	MeshModel& layer = layers.add("lines of curvature", cloudLayer);
	writeLines(layer, lines, estimate.prepared, cloudLayer.id());
	layers.keep(layer);

	results.count("points", points.size());
	results.count("invalid", estimate.prepared.nonFinite + estimate.prepared.zeroNormals);
	results.count("umbilic", std::count(umbilics.umbilic.begin(), umbilics.umbilic.end(), char(1)));
	results.count("umbilic_regions", umbilics.regions);
	results.count("lines", lines.lines());
	results.count("lines_family_1", std::count(lines.family.begin(), lines.family.end(), 1));
	results.count("lines_family_2", std::count(lines.family.begin(), lines.family.end(), 2));
	const auto ends = [&](LineEnd kind) {
		Index count = 0;
		for (const auto& both : lines.ends)
			count += std::count(both.begin(), both.end(), kind);
		return count;
	};
	results.count("ends_at_lines", ends(LineEnd::Line));
	results.count("ends_at_rims", ends(LineEnd::Rim));
	results.count("ends_at_creases", ends(LineEnd::Crease));
	results.count("ends_at_umbilics", ends(LineEnd::Umbilic));
	results.count("closed_lines", std::count(lines.closed.begin(), lines.closed.end(), char(1)));
	results.count("crossings", lines.crossings);
	results.count("vertices", lines.vertices.cols());
	results.count("edges", layer.cm.en);
	results.real("epsilon", lines.epsilon);
	results.flag("curvature_reused", curvature.reused);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec traceLinesFilter()
{
	return {
		"Trace Lines of Curvature",
		"generate_curvature_lines",
		"Traces the lines of curvature as a new polyline layer",
		"Traces the lines of curvature of a point cloud, the curves that follow the two families "
		"of "
		"principal directions, without a mesh. Lines start where the curvature estimate is most "
		"reliable; they are as dense as the curvature across them asks for." +
			helpInput +
			"<br><br><b>Writes</b> a new layer '<i>lines of curvature</i>' of vertices and edges, "
			"and "
			"makes it current: normals, quality (the curvature along the line), colour (orange "
			"along PD1, blue along PD2) and the vertex attributes <tt>line_id</tt>, "
			"<tt>line_family</tt> (1 or 2), <tt>line_closed</tt> (1 of a closed line) and "
			"<tt>line_arc_length</tt> (from the line's first vertex, in the layer's units). "
			"<i>Build Curvature-Aligned Quad Mesh</i> goes on from "
			"there. Save it as OBJ: PLY drops edges." +
			helpChaining + helpConventions + helpReference,
		FilterPlugin::Normal + FilterPlugin::PointSet + FilterPlugin::MeshCreation,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_NONE,
		{parameters, apply}};
}

} // namespace curvature_lines
