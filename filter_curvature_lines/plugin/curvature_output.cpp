// Attributes, quality and colour of a curvature estimate, and its counts.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_output.h"

#include <map>

#include <Eigen/Core>

#include "curvature_colors.h"
#include "filter_results.h"
#include "layer_conversion.h"
#include "layer_curvature.h"
#include "neighborhoods.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "raw_curvatures.h"

namespace curvature_lines {

void curvatureOutputParameters(ParameterTable& table, CurvatureOutput& output)
{
	table.row(
		"scalar",
		output.scalar,
		Choice{{"Mean", "Gaussian", "K1", "K2", "Curvedness", "Shape Index", "Confidence"}},
		"Quality",
		"What is stored as vertex quality.<ul>"
		"<li><b>Mean</b>: (k1 + k2) / 2</li>"
		"<li><b>Gaussian</b>: k1 k2</li>"
		"<li><b>K1</b>, <b>K2</b>: the larger and the smaller principal curvature</li>"
		"<li><b>Curvedness</b>: sqrt((k1^2 + k2^2) / 2)</li>"
		"<li><b>Shape Index</b>: +1 convex cap, 0 saddle, -1 concave cup</li>"
		"<li><b>Confidence</b>: how much the neighbours' estimates rely on the point</li></ul>");
	table.row(
		"colorize",
		output.colorize,
		Flag(),
		"Colour the points",
		"With Mean, by both principal curvatures at once: convex red, saddle green, concave blue, "
		"flat white. With the other scalars, by MeshLab's quality ramp between the 10th and the "
		"90th percentile.");
}

void writeCurvatureOutput(
	MeshModel&             layer,
	const LayerPoints&     points,
	double                 diagonal,
	const RawCurvatures&   values,
	const CurvatureOutput& output)
{
	const Eigen::VectorXd quality = scalarsOf(values, output.scalar);
	writeCurvature(layer, points, values);
	writeQuality(layer, points, quality);
	if (output.colorize && output.scalar == CurvatureScalar::Mean)
		writeColors(layer, points, curvatureColors(values.k1, values.k2, 0.5 * diagonal));
	else if (output.colorize) {
		const auto [from, to] = rampRange(quality, values.status);
		writeColorRamp(layer, from, to);
	}
}

void reportCurvature(
	FilterResults&              results,
	const PreparedCloud&        prepared,
	const MinimumNeighborhoods& minimum,
	const RawCurvatures&        values)
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
	results.count("duplicates", prepared.duplicates);
	results.real("median_spacing", minimum.medianSpacing * prepared.diagonal);
}

} // namespace curvature_lines
