// Robust Curvature (M-Estimation): core/robust_curvature on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_table.h"
#include "help_text.h"

#include "core/curvature_colors.h"

namespace curvature_lines {

namespace {

enum class Scalar { Mean, Gaussian, K1, K2, Curvedness, ShapeIndex, Confidence };

RichParameterList parameters(const MeshDocument&)
{
	RichParameterList list;
	addEstimateParameters(list);
	list.addParam(RichBool(
		"correct_normals",
		false,
		"Correct normals",
		"Replace the normals by those of the fitted surface; PD1 and PD2 are then tangent to them. "
		"(With Scale Paper the curvature is estimated once more with the corrected normals; the "
		"adaptive estimate does not depend on the given ones beyond their side.)"));
	list.addParam(RichEnum(
		"scalar",
		0,
		QStringList() << "Mean"
					  << "Gaussian"
					  << "K1"
					  << "K2"
					  << "Curvedness"
					  << "Shape Index"
					  << "Confidence",
		"Quality",
		"What is stored as vertex quality.<ul>"
		"<li><b>Mean</b>: (k1 + k2) / 2</li>"
		"<li><b>Gaussian</b>: k1 k2</li>"
		"<li><b>K1</b>, <b>K2</b>: the larger and the smaller principal curvature</li>"
		"<li><b>Curvedness</b>: sqrt((k1^2 + k2^2) / 2)</li>"
		"<li><b>Shape Index</b>: +1 convex cap, 0 saddle, -1 concave cup</li>"
		"<li><b>Confidence</b>: how much the neighbours' estimates rely on the point</li></ul>"));
	list.addParam(RichBool(
		"colorize",
		true,
		"Colour the points",
		"With Mean, by both principal curvatures at once: convex red, saddle green, concave blue, "
		"flat white. With the other scalars, by MeshLab's quality ramp between the 10th and the "
		"90th percentile."));
	addUmbilicRatio(list);
	return list;
}

double scalarOf(Scalar scalar, const VertexCurvatures& values, Index i)
{
	const double k1 = values.k1[i], k2 = values.k2[i];
	switch (scalar) {
	case Scalar::Mean:
		return 0.5 * (k1 + k2);
	case Scalar::Gaussian:
		return k1 * k2;
	case Scalar::K1:
		return k1;
	case Scalar::K2:
		return k2;
	case Scalar::Curvedness:
		return curvedness(k1, k2);
	case Scalar::ShapeIndex:
		return shapeIndex(k1, k2);
	case Scalar::Confidence:
		return values.confidence[i];
	}
	return 0.0;
}

void reportCounts(
	FilterResults& results, const CurvatureEstimate& estimate, const VertexCurvatures& values)
{
	std::map<PointStatus, Index> counts;
	for (const PointStatus status : values.status)
		++counts[status];
	results.count("points", static_cast<Index>(values.status.size()));
	results.count("ok", counts[PointStatus::Ok]);
	results.count("boundary", counts[PointStatus::Boundary]);
	results.count("too_few_neighbors", counts[PointStatus::TooFewNeighbors]);
	results.count("umbilic", counts[PointStatus::Umbilic]);
	results.count("isolated", counts[PointStatus::Isolated]);
	results.count("invalid", counts[PointStatus::Invalid]);
	results.count("duplicates", estimate.prepared.duplicates);
	results.count("iterations", estimate.field.iterations);
	results.real("median_spacing", estimate.minimum.medianSpacing * estimate.prepared.diagonal);
}

FilterResults apply(const FilterContext& context)
{
	const Parameters&     parameters = context.parameters;
	const EstimateOptions options    = estimateOptions(parameters);
	const auto            scalar     = static_cast<Scalar>(parameters.choice("scalar"));
	const bool            correct    = parameters.flag("correct_normals");
	const bool            colorize   = parameters.flag("colorize");
	UmbilicOptions        umbilicOptions;
	umbilicOptions.ratio = umbilicRatio(parameters);

	MeshModel&    layer  = currentLayer(context.document);
	LayerPoints   points = readOrientedPoints(layer);
	FilterResults results;
	Stopwatch     total, stage;
	const auto estimate =
		correct ? context.cache.estimateAndCorrect(points, options, context.progress) :
				  context.cache.estimate(points, options, context.progress);
	results.seconds("curvature", stage.lap());

	const UmbilicRegions umbilics =
		findUmbilics(estimate->prepared.cloud, estimate->field, estimate->minimum, umbilicOptions);
	const VertexCurvatures values =
		perVertex(points, estimate->prepared, estimate->field, umbilics.umbilic);
	Eigen::VectorXd quality(points.size());
	for (Index i = 0; i < points.size(); ++i)
		quality[i] = scalarOf(scalar, values, i);
	Eigen::Matrix3Xd colors;
	if (colorize && scalar == Scalar::Mean)
		colors = curvatureColors(values.k1, values.k2, 0.5 * estimate->prepared.diagonal);

	if (correct)
		for (Index i = 0; i < points.size(); ++i)
			for (int c = 0; c < 3; ++c)
				layer.cm.vert[points.vertex[i]].N()[c] = Scalarm(points.normals(c, i));
	writeCurvature(layer, points, values);
	writeQuality(layer, points, quality);
	if (colorize && scalar == Scalar::Mean)
		writeColors(layer, points, colors);
	else if (colorize)
		writeColorRamp(layer, points, values.status);

	reportCounts(results, *estimate, values);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec robustCurvatureFilter()
{
	return {
		"Robust Curvature (M-Estimation)",
		"compute_curvature_robust_per_vertex",
		"Principal curvatures and directions of a point cloud, insensitive to noise, outliers and "
		"wrong normals. An M-estimator (Geman-McClure) gives what disagrees less weight, down to "
		"none, so that outliers and points across a sharp edge do not count."
		"<br><br>By default the surface is fitted to the positions in regions whose size is found "
		"from the cloud; the normals given tell its side and no more. With Scale <i>Paper</i>, the "
		"variations of the normals between all pairs of points within three spacings are fitted by "
		"a curvature tensor, as published." +
			helpInput +
			"<br><br><b>Writes</b> K1, K2, PD1, PD2 (shown by the decorator <i>Curvature</i>); "
			"vertex "
			"quality and colour; and the vertex attributes <tt>curv_k1</tt>, <tt>curv_k2</tt>, "
			"<tt>curv_confidence</tt>, <tt>curv_error</tt> (standard error of k1 - k2), "
			"<tt>curv_scale</tt> (radius used), <tt>curv_feature</tt> (strength of the sharp edge or "
			"corner nearby, 0 to 1; always 0 with Scale Paper) and <tt>curv_status</tt> (0 ok, 1 "
			"boundary, 2 too few neighbours, 3 umbilic, 4 isolated, 5 invalid). Points without an "
			"estimate get curvature 0. PD1 and PD2 are tangent to the fitted surface: to the layer's "
			"normals where these agree with it within a degree, with Scale Paper always, and with "
			"<i>Correct normals</i> to the normals it writes." +
			helpConventions + helpReference,
		FilterPlugin::Normal + FilterPlugin::PointSet + FilterPlugin::VertexColoring,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTNORMAL | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR |
			MeshModel::MM_VERTCURVDIR,
		parameters,
		apply};
}

} // namespace curvature_lines
