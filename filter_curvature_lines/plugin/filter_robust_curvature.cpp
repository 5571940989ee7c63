// Robust Curvature (M-Estimation): core/robust_curvature on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_cache.h"
#include "curvature_output.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "raw_curvatures.h"
#include "shared_parameters.h"
#include "umbilics.h"

namespace curvature_lines {

namespace {

struct Options {
	EstimateOptions estimate;
	bool            correctNormals = false;
	CurvatureOutput output;
	UmbilicOptions  umbilics;
};

void parameters(ParameterTable& table, Options& options)
{
	estimateParameters(table, options.estimate);
	table.row(
		"correct_normals",
		options.correctNormals,
		Flag(),
		"Correct normals",
		"Replace the normals by those of the fitted surface; PD1 and PD2 are then tangent to them. "
		"(With Scale Paper the curvature is estimated once more with the corrected normals; the "
		"adaptive estimate does not depend on the given ones beyond their side.)");
	curvatureOutputParameters(table, options.output);
	umbilicParameter(table, options.umbilics);
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	MeshModel&    layer  = currentLayer(context.document);
	LayerPoints   points = readOrientedPoints(layer, context.progress);
	FilterResults results;
	Stopwatch     total, stage;
	const auto    estimate =
        options.correctNormals
			   ? context.cache.estimateAndCorrect(points, options.estimate, context.progress)
			   : context.cache.estimate(points, options.estimate, context.progress);
	results.seconds("curvature", stage.lap());

	const UmbilicRegions umbilics = findUmbilics(
		estimate->prepared.cloud, estimate->field, estimate->index.minimum(), options.umbilics);
	const RawCurvatures values =
		rawCurvatures(points.normals, estimate->prepared, estimate->field, umbilics.umbilic);

	if (options.correctNormals)
		for (Index i = 0; i < points.size(); ++i)
			for (int c = 0; c < 3; ++c) // those that are not finite stay as they are
				layer.cm.vert[points.vertex[i]].N()[c] = Scalarm(points.normals(c, i));
	writeCurvatureOutput(layer, points, estimate->prepared.diagonal, values, options.output);

	reportCurvature(results, estimate->prepared, estimate->index.minimum(), values);
	results.count("iterations", estimate->field.iterations);
	reportNormals(results, points, true);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec robustCurvatureFilter()
{
	return {
		"Robust Curvature (M-Estimation)",
		"compute_curvature_robust_per_vertex",
		"Principal curvatures and directions of a noisy cloud, by M-estimation",
		"Principal curvatures and directions of a point cloud, insensitive to noise, outliers and "
		"wrong normals. An M-estimator (Geman-McClure) gives what disagrees less weight, down to "
		"none, so that outliers and points across a sharp edge do not count."
		"<br><br>By default (Scale <i>Adaptive</i>) surfaces are fitted to the positions, in "
		"regions whose "
		"size is found from the cloud; the normals only tell the side. With Scale <i>Paper</i> a "
		"tensor is "
		"fitted to the normals within three spacings, as published." +
			helpInput +
			"<br><br><b>Writes</b> K1, K2, PD1, PD2 (shown by the decorator <i>Curvature</i>; "
			"tangent to "
			"the fitted surface); vertex quality and colour; and the vertex attributes "
			"<tt>curv_k1</tt>, "
			"<tt>curv_k2</tt>, <tt>curv_confidence</tt>, <tt>curv_error</tt> (standard error of k1 "
			"- k2), "
			"<tt>curv_scale</tt> (radius used), <tt>curv_feature</tt> (sharp edge nearby, 0 to 1) "
			"and "
			"<tt>curv_status</tt> (0 ok, 1 boundary, 2 too few neighbours, 3 umbilic, 4 isolated, "
			"5 "
			"invalid). Points without an estimate get curvature 0." +
			helpConventions + helpReference,
		FilterPlugin::Normal + FilterPlugin::PointSet + FilterPlugin::VertexColoring,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTNORMAL | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR |
			MeshModel::MM_VERTCURVDIR,
		{parameters, apply}};
}

} // namespace curvature_lines
