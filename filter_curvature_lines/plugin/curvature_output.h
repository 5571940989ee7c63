// How a curvature filter shows its estimate: attributes, vertex quality, colour, and counts of points per status.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "filter_results.h"
#include "layer_conversion.h"
#include "neighborhoods.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "raw_curvatures.h"

namespace curvature_lines {

struct CurvatureOutput {
	CurvatureScalar scalar   = CurvatureScalar::Mean;
	bool            colorize = true;
};

void curvatureOutputParameters(ParameterTable& table, CurvatureOutput& output);

// K1, K2, PD1, PD2, attributes, quality and colour.
void writeCurvatureOutput(
	MeshModel&             layer,
	const LayerPoints&     points,
	double                 diagonal, // of the cloud, model units
	const RawCurvatures&   values,
	const CurvatureOutput& output);

void reportCurvature(
	FilterResults&              results,
	const PreparedCloud&        prepared,
	const MinimumNeighborhoods& minimum,
	const RawCurvatures&        values);

} // namespace curvature_lines
