// M-Weighted Curvature (Euler Least Squares): core/m_weighted_curvature on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_index.h"
#include "curvature_field.h"
#include "curvature_output.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "m_weighted_curvature.h"
#include "neighborhoods.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "raw_curvatures.h"
#include "shared_parameters.h"
#include "umbilics.h"

namespace curvature_lines {

namespace {

struct Options {
	MWeightedCurvatureOptions estimate;
	CurvatureOutput           output;
	UmbilicOptions            umbilics;
};

void parameters(ParameterTable& table, Options& options)
{
	table.row(
		"bandwidth",
		options.estimate.bandwidth,
		Real{0.5, 20.0},
		"Bandwidth (spacings)",
		"Length h of the weights, in local point spacings (0.5 to 20). The weight is largest at h "
		"times the root of the exponent. Larger resists more noise and blurs more detail.");
	table.row(
		"exponent",
		options.estimate.exponent,
		Integer{1, 10},
		"Exponent (M weights)",
		"With M weights, the power xi of x^(2 xi) exp(-x^2 / h^2) (1 to 10): the larger, the less "
		"the closest points count.");
	table.row(
		"neighbors",
		options.estimate.neighbors,
		Integer{6, 1000},
		"Neighbours (number)",
		"Nearest points looked at around each point (6 to 1000).");
	table.row(
		"weighting",
		options.estimate.weighting,
		Choice{{"M", "Gaussian", "Unweighted"}},
		"Weights",
		"How much a neighbour counts by its distance x.<ul>"
		"<li><b>M</b>: x^(2 xi) exp(-x^2 / h^2), little where close, as published</li>"
		"<li><b>Gaussian</b>: exp(-x^2 / h^2), for comparison: noise makes close points wild</li>"
		"<li><b>Unweighted</b>: all neighbours alike</li></ul>");
	curvatureOutputParameters(table, options.output);
	umbilicParameter(table, options.umbilics);
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	MeshModel&                  layer  = currentLayer(context.document);
	const LayerPoints           points = readOrientedPoints(layer, context.progress);
	FilterResults               results;
	Stopwatch                   total;
	const PreparedCloud         prepared = prepareCloud(points.positions, points.normals);
	const CloudIndex            index(prepared.cloud);
	const MinimumNeighborhoods& minimum =
		index.minimum(context.progress.sub(0.0, 0.4, "Finding neighborhoods"));
	const CurvatureField field = mWeightedCurvature(
		index, options.estimate, context.progress.sub(0.4, 1.0, "Estimating curvature"));
	const RawCurvatures values = rawCurvatures(
		points.normals,
		prepared,
		field,
		findUmbilics(prepared.cloud, field, minimum, options.umbilics).umbilic);

	writeCurvatureOutput(layer, points, prepared.diagonal, values, options.output);
	reportCurvature(results, prepared, minimum, values);
	reportNormals(results, points, true);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec mWeightedCurvatureFilter()
{
	return {
		"M-Weighted Curvature (Euler Least Squares)",
		"compute_curvature_m_weighted_per_vertex",
		"Principal curvatures and directions of a clean cloud, by Euler's theorem",
		"Principal curvatures and directions of a point cloud from the directional curvatures "
		"towards each point's neighbours, which Euler's theorem ties together: one small least "
		"squares per point. Neighbours count most at a distance: close ones carry the noise, far "
		"ones do not belong. Fast and simple, for clouds with good normals and little noise; "
		"<i>Robust Curvature</i> finds its scale by itself and withstands noise, outliers and "
		"wrong normals." +
			helpInput +
			"<br><br><b>Writes</b> K1, K2, PD1, PD2 (shown by the decorator <i>Curvature</i>); "
			"vertex "
			"quality and colour; and the vertex attributes <tt>curv_k1</tt>, <tt>curv_k2</tt>, "
			"<tt>curv_confidence</tt>, <tt>curv_error</tt>, <tt>curv_scale</tt>, "
			"<tt>curv_feature</tt> (always 0) and <tt>curv_status</tt>, as <i>Robust Curvature</i> "
			"does. PD1 and PD2 are tangent to the layer's normals. Filters that go on from "
			"curvature "
			"use the robust one." +
			helpConventions + helpReferenceTejada,
		FilterPlugin::Normal + FilterPlugin::PointSet + FilterPlugin::VertexColoring,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTCURVDIR,
		{parameters, apply}};
}

} // namespace curvature_lines
