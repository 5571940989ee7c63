// Smooth Principal Directions: core/direction_smoothing on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "curvature_cache.h"
#include "curvature_field.h"
#include "direction_smoothing.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "layer_curvature.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "raw_curvatures.h"
#include "umbilics.h"

namespace curvature_lines {

namespace {

void parameters(ParameterTable& table, DirectionSmoothingOptions& options)
{
	table.row(
		"alpha",
		options.alpha,
		Real{0.0, 1.0},
		"Smoothness (0 to 1)",
		"0 keeps the directions, 1 gives the smoothest field.");
	table.row(
		"iterations",
		options.iterations,
		Integer{1, 10000},
		"Iterations",
		"Largest number of iterations of the optimiser (1 to 10000).",
		advancedParameter);
}

FilterResults apply(const FilterContext& context, const DirectionSmoothingOptions& options)
{
	MeshModel&           layer  = currentLayer(context.document);
	const LayerPoints    points = readOrientedPoints(layer, context.progress);
	Stopwatch            total, stage;
	FilterResults        results;
	const LayerCurvature curvature =
		context.cache.ofLayer(layer, points, context.progress.sub(0.0, 0.7, ""));
	const CurvatureEstimate& estimate = *curvature.estimate;
	results.seconds("curvature", stage.lap());

	DirectionSmoothingResult smoothed = smoothDirections(
		estimate.prepared.cloud,
		*curvature.field,
		options,
		context.progress.sub(0.7, 1.0, "Smoothing directions"));
	results.seconds("smoothing", stage.lap());

	CurvatureField field = *curvature.field;
	field.d1             = std::move(smoothed.d1);
	field.d2             = std::move(smoothed.d2);
	const UmbilicRegions umbilics =
		findUmbilics(estimate.prepared.cloud, field, estimate.index.minimum());
	writeCurvature(
		layer, points, rawCurvatures(points.normals, estimate.prepared, field, umbilics.umbilic));

	results.count("points", points.size());
	results.count("invalid", estimate.prepared.nonFinite + estimate.prepared.zeroNormals);
	results.count("iterations", smoothed.iterations);
	results.real("energy_initial", smoothed.initialEnergy);
	results.real("energy_final", smoothed.finalEnergy);
	results.real("mean_turn", smoothed.meanTurn);
	results.flag("curvature_reused", curvature.reused);
	reportNormals(results, points, true);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec smoothDirectionsFilter()
{
	return {
		"Smooth Principal Directions",
		"apply_curvature_direction_smoothing_per_vertex",
		"Smooths the principal directions where they are uncertain",
		"Smooths the field of principal directions of a point cloud as a whole: each direction "
		"stays near its estimate where k1 - k2 is well above its standard error, and follows its "
		"neighbours where it is not (near umbilics, on flat parts, under noise). Directions do not "
		"mix across sharp edges." +
			helpInput +
			"<br><br><b>Writes</b> PD1 and PD2 (and K1, K2 and the <tt>curv_*</tt> attributes that "
			"go "
			"with them). Applied again, it smooths further. <i>Trace Lines of Curvature</i> "
			"follows "
			"the smoothed directions." +
			helpChaining + helpConventions + helpReference,
		FilterPlugin::Normal + FilterPlugin::PointSet + FilterPlugin::Smoothing,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTCURVDIR,
		{parameters, apply}};
}

} // namespace curvature_lines
