// Denoise Point Cloud by Robust Curvature: core/denoising on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cleaning_report.h"
#include "curvature_cache.h"
#include "denoising.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

void parameters(ParameterTable& table, DenoisingOptions& options)
{
	table.row(
		"method",
		options.method,
		Choice{{"Robust", "Paper"}},
		"Method",
		"How the points are moved.<ul>"
		"<li><b>Robust</b>: onto the surfaces their neighbours fit, at a radius found from the "
		"cloud; "
		"edges stay sharp. Needs no curvature</li>"
		"<li><b>Paper</b>: all at once, so that the triangles of each point with its neighbours "
		"agree with the corrected normals (a global energy, as published)</li></ul>");
	table.row(
		"noise",
		options.robust.noise,
		Length(),
		"Noise (length; 0: automatic)",
		"Robust: standard deviation of the points from the surface, a length in the layer's units "
		"(0 = automatic, at most half the bounding-box diagonal).");
	table.row(
		"radius",
		options.robust.radius,
		AutomaticOr{2.5, 100.0},
		"Radius (spacings; 0: automatic)",
		"Robust: size of the fitted pieces of surface, in local point spacings (0 = automatic, at "
		"least 2.5 and at most 100). Larger ones remove more noise and more detail.");
	table.row(
		"iterations",
		options.paper.iterations,
		Integer{1, 10000},
		"Iterations (Paper)",
		"Paper: largest number of iterations of the optimiser (1 to 10000).",
		advancedParameter);
	table.row(
		"energy",
		options.paper.energy,
		Choice{{"Square Root", "Squared"}},
		"Energy (Paper)",
		"Paper: power of the disagreement between triangle and normal.<ul>"
		"<li><b>Square Root</b>: as published in 2009, respects edges</li>"
		"<li><b>Squared</b>: smoother, removes more noise on smooth surfaces</li></ul>",
		advancedParameter);
	table.row(
		"optimizer",
		options.paper.optimizer,
		Choice{{"L-BFGS-B", "Polak-Ribiere"}},
		"Optimiser (Paper)",
		"Paper: L-BFGS-B (2009), or Polak-Ribiere conjugate gradients (2007).",
		advancedParameter);
	table.row(
		"neighbors",
		options.paper.neighbors,
		Choice{{"Six Sectors", "Nearest"}},
		"Neighbours (Paper)",
		"Paper: the six neighbours of each point: the closest in each sixth of the tangent plane, "
		"or the "
		"six nearest.",
		advancedParameter);
}

FilterResults apply(const FilterContext& context, const DenoisingOptions& options)
{
	MeshModel&          layer  = currentLayer(context.document);
	const LayerPoints   points = readOrientedPoints(layer, context.progress);
	const Stopwatch     total;
	const PreparedCloud prepared  = prepareCloud(points.positions, points.normals);
	const auto          robust    = inUnitFrame(options.robust, prepared);
	const bool          published = options.method == DenoisingOptions::Method::Paper;
	FilterResults       results;
	DenoisingResult     denoised;
	Stopwatch           stage;
	if (published) {
		const LayerCurvature curvature = context.cache.ofLayer(
			layer, points, context.progress.sub(0.0, 0.5, "Estimating curvature"));
		results.flag("curvature_reused", curvature.reused);
		results.seconds("curvature", stage.lap());
		denoised = denoiseAsPublished(
			curvature.estimate->index,
			curvature.estimate->field.correctedNormals,
			options.paper,
			context.progress.sub(0.5, 1.0, "Denoising"));
	}
	else {
		denoised = denoiseByProjection(prepared.cloud, robust, context.progress);
	}
	results.seconds("denoising", stage.lap());
	writePositions(layer, points, prepared, denoised.positions);
	writeNormals(layer, points, prepared, denoised.normals);

	results.count("points", points.size());
	results.count("warnings", 0);
	results.count("invalid", prepared.nonFinite + prepared.zeroNormals);
	results.count("duplicates", prepared.duplicates);
	if (published) {
		results.count("iterations", denoised.iterations);
		results.real("energy_initial", denoised.initialEnergy);
		results.real("energy_final", denoised.finalEnergy);
	}
	else {
		results.real("noise", denoised.pointDeviation * prepared.diagonal);
		results.real("radius", denoised.radius);
		reportDoubledLayers(results, denoised.doubledShare);
	}
	results.real("moved_rms", denoised.rmsMove * prepared.diagonal);
	results.real("moved_max", denoised.maxMove * prepared.diagonal);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec denoiseFilter()
{
	return {
		"Denoise Point Cloud by Robust Curvature",
		"apply_coord_point_cloud_robust_denoising",
		"Moves the points onto the surface and corrects the normals",
		"Removes noise from a point cloud. Every point moves onto the surface that its neighbours "
		"agree on: overlapping pieces of it are fitted, as large as the noise asks for and the "
		"shape allows, and those that bend over a sharp edge do not count. The layer's normals "
		"only tell the side of the surface." +
			helpInput +
			"<br><br><b>Writes</b> coordinates and normals. Curvature on the layer then belongs to "
			"the former points: compute it again. With method Paper the points also slide along "
			"the "
			"surface by about the size of the noise: do not use it on clouds whose colours matter "
			"in detail. Outliers should be removed before (<i>Select Outliers by Robust "
			"Curvature</i>)."
			"<br><br>Method Paper uses curvature that is already on the layer and still fits its "
			"points and normals, and otherwise computes it with default settings." +
			helpReference,
		FilterPlugin::PointSet + FilterPlugin::Smoothing,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTCOORD | MeshModel::MM_VERTNORMAL,
		{parameters, apply}};
}

} // namespace curvature_lines
