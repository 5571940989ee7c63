// Extract Sharp Feature Lines: core/creases on a denoised copy of a layer's points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "cloud_index.h"
#include "crease_curves.h"
#include "creases.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "polyline_layer.h"
#include "robust_denoising.h"

namespace curvature_lines {

namespace {

struct Options {
	CreaseOptions creases; // spacing in model units
	bool          denoise = true;
};

void parameters(ParameterTable& table, Options& options)
{
	table.row(
		"min_angle",
		options.creases.minAngle,
		Real{5.0, 150.0},
		"Smallest angle (degrees)",
		"A line is kept if somewhere the normals of its two faces differ by this many degrees (5 "
		"to "
		"150); from there it is followed until six tenths of it are left. Lower values find softer "
		"edges, and more that noise makes up.");
	table.row(
		"spacing",
		options.creases.spacing,
		Length(),
		"Vertex spacing (length; 0: automatic)",
		"Distance between the vertices of the lines, in the layer's units; 0 = automatic, 0.7 "
		"times "
		"the point spacing.");
	table.row(
		"denoise",
		options.denoise,
		Flag(),
		"Denoise first",
		"Search a denoised copy of the points (as <i>Denoise Point Cloud by Robust Curvature</i> "
		"makes it). Without, the points and their normals are taken as they are: for clouds "
		"denoised "
		"before, and exact ones.",
		advancedParameter);
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	MeshModel&        cloudLayer = currentLayer(context.document);
	const LayerPoints points     = readOrientedPoints(cloudLayer, context.progress);
	Stopwatch         total, stage;
	FilterResults     results;
	PreparedCloud     prepared = prepareCloud(points.positions, points.normals);
	if (options.denoise) {
		RobustDenoisingResult denoised =
			denoiseRobustly(prepared.cloud, {}, context.progress.sub(0.0, 0.8, "Denoising"));
		prepared.cloud.positions = std::move(denoised.positions);
		prepared.cloud.normals   = std::move(denoised.normals);
		results.seconds("denoising", stage.lap());
	}
	const CloudIndex index(prepared.cloud);
	index.minimum(context.progress.sub(0.8, 0.85, "Finding neighborhoods"));
	CreaseOptions creaseOptions = options.creases;
	creaseOptions.spacing /= prepared.diagonal;
	const Creases creases =
		findCreases(index, creaseOptions, context.progress.sub(0.85, 1.0, "Finding creases"));
	results.seconds("creases", stage.lap());

	const CreaseTotals totals = totalsOf(creases, prepared.diagonal);
	results.count("vertices", 0);
	results.count("edges", 0);
	if (!creases.curves.empty()) { // smooth surfaces are nothing wrong
		NewLayers  layers(context.document);
		MeshModel& layer = layers.add("sharp features", cloudLayer);
		writeCreases(layer, creases, prepared);
		layers.keep(layer);
		results.count("vertices", layer.cm.vn);
		results.count("edges", layer.cm.en);
	}
	results.count("points", points.size());
	results.count("invalid", prepared.nonFinite + prepared.zeroNormals);
	results.count("curves", static_cast<Index>(creases.curves.size()));
	results.count("closed_curves", totals.closed);
	results.count("concave_curves", totals.concave);
	results.count("corners", static_cast<Index>(creases.corners.size()));
	results.real("length", totals.length);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec sharpFeaturesFilter()
{
	return {
		"Extract Sharp Feature Lines",
		"generate_sharp_feature_lines",
		"Finds the sharp edges of the surface as a new polyline layer",
		"Finds the sharp edges of a point cloud, without a mesh: lines where two faces meet at an "
		"angle, and "
		"the corners where they end together. Both faces are continued to where they intersect, so "
		"the "
		"lines are more exact than the points beside them. Rims, and smooth bends of several point "
		"spacings, are no such lines." +
			helpInput +
			" Remove outliers before (<i>Select Outliers by Robust Curvature</i>)."
			"<br><br><b>Writes</b> a new layer '<i>sharp features</i>' of vertices and edges, "
			"unless there "
			"is no sharp edge: normals (the mean of the two faces'), quality (the angle between "
			"the faces' "
			"normals in degrees, positive where convex), colour (orange convex, blue concave), "
			"attribute "
			"<tt>line_id</tt>. Save it as OBJ: PLY drops edges." +
			helpReference,
		FilterPlugin::PointSet + FilterPlugin::MeshCreation,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_NONE,
		{parameters, apply}};
}

} // namespace curvature_lines
