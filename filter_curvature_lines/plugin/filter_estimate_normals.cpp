// Estimate and Orient Normals: core/normal_estimation on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>

#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "host_types.h"
#include "layer_conversion.h"
#include "normal_estimation.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

struct Options {
	NormalEstimationOptions normals;
	bool                    flip = false;
};

void parameters(ParameterTable& table, Options& options)
{
	table.row(
		"orientation",
		options.normals.openSides,
		Choice{{"Automatic", "Viewpoint", "Up"}},
		"Sides of open parts",
		"Closed parts get outward normals by winding numbers. Open ones get one side, and this "
		"tells which.<ul>"
		"<li><b>Automatic</b>: either one</li>"
		"<li><b>Viewpoint</b>: the one that looks at Viewpoint, as of a scanner</li>"
		"<li><b>Up</b>: the one that looks along +z, as of terrain</li></ul>");
	table.row(
		"viewpoint",
		options.normals.viewpoint,
		Position(),
		"Viewpoint",
		"Viewpoint: where the surface was seen from, in the layer's coordinates.");
	table.row(
		"flip",
		options.flip,
		Flag(),
		"Flip all",
		"Turn all normals round at the end.",
		advancedParameter);
	table.row(
		"neighbors",
		options.normals.neighbors,
		Integer{0, 1000},
		"Neighbours (0: automatic)",
		"Points each plane is fitted to (0 = automatic: 25, and more as far as the cloud is noisy; "
		"at most 1000).",
		advancedParameter);
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	MeshModel&        layer  = currentLayer(context.document);
	const LayerPoints points = readPoints(layer);
	FilterResults     results;
	const Stopwatch   total;

	const PreparedCloud prepared = withoutNormals(points.positions);
	EstimatedNormals    estimate =
		estimateNormalsOfAll(prepared, points.normals, options.normals, context.progress);
	if (options.flip)
		estimate.normals = -estimate.normals;
	for (Index i = 0; i < points.size(); ++i)
		if (prepared.representative[i] >= 0)
			layer.cm.vert[points.vertex[i]].N() = toPoint(estimate.normals.col(i));
	writeAttribute(layer, points, "normal_doubt", estimate.doubt);

	results.count("points", points.size());
	results.count("invalid", prepared.nonFinite);
	results.count("duplicates", prepared.duplicates);
	results.count("warnings", 0);
	reportSides(results, estimate);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec estimateNormalsFilter()
{
	return {
		"Estimate and Orient Normals",
		"compute_normals_robust_point_cloud",
		"Normals of a cloud that has none, outward also on thin walls",
		"Estimates the normals of a point cloud from its positions and gives them sides. The sides "
		"come from winding numbers: of all directions those are found that make the cloud the "
		"border of a solid, which also tells apart the two sides of a thin wall, separate parts "
		"and "
		"shells inside each other. Normals the layer has are replaced."
		"<br><br><b>Writes</b> normals, and the attribute <i>normal_doubt</i>: 0 where the "
		"neighbours agree on the side, 1 where they do not. The result <i>doubtful_share</i> is "
		"the "
		"share of points with a doubt over 0.4, and over 5 % there is a warning; <i>open_share</i> "
		"is the share on open parts, where either side would do. A whole thin part that is inside "
		"out has no doubt: look at the normals of thin walls in noisy clouds." +
			helpReference,
		FilterPlugin::PointSet + FilterPlugin::Normal,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTNORMAL,
		{parameters, apply}};
}

} // namespace curvature_lines
