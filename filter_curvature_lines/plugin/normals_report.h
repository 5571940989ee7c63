// What the filters say about the normals they used: those of the layer, or those made in their place.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cleaning_report.h"
#include "filter_results.h"
#include "layer_conversion.h"
#include "normal_check.h"
#include "normal_estimation.h"

namespace curvature_lines {

// After the last count("warnings", 0) of the filter.
inline void reportSides(FilterResults& results, const EstimatedNormals& estimate)
{
	constexpr double told = 0.05;
	results.real("doubtful_share", estimate.doubtfulShare);
	results.real("open_share", estimate.undecidedShare);
	if (estimate.doubtfulShare > told)
		results.warn(
			"The side of the normals is in doubt at " + aboutShare(estimate.doubtfulShare) +
			" (doubtful_share): thin walls, or noise as large as the details. Colour the layer by "
			"the attribute 'normal_doubt' of Estimate and Orient Normals, and look at the normals "
			"there before you go on.");
}

inline void reportGivenNormals(FilterResults& results, const NormalCheck& check)
{
	constexpr double  toldLength = 0.1, toldDisagreeing = 0.1, toldTorn = 0.02;
	const std::string cure = " Replace them with Estimate and Orient Normals "
							 "(compute_normals_robust_point_cloud).";
	results.real("normals_disagreeing", check.disagreeing);
	results.real("normals_torn", check.torn);
	if (check.allEqual)
		results.warn("The normals of the layer are all equal, the surface is not flat." + cure);
	else if (check.disagreeing > toldDisagreeing)
		results.warn(
			"The normals of the layer are far from upright on the surface at " +
			aboutShare(check.disagreeing) + " (normals_disagreeing)." + cure);
	if (check.torn > toldTorn)
		results.warn(
			"The normals of the layer change sides within the surface (normals_torn)." + cure);
	if (check.notUnit > toldLength)
		results.warn(
			"The normals of the layer are not of length 1 at " + aboutShare(check.notUnit) +
			"; only their directions are used. Normalise them if they are normals at all, or "
			"estimate "
			"new ones (compute_normals_robust_point_cloud).");
}

// Of what readOrientedPoints() returned. `signs`: the results have other signs on the other side of the surface.
inline void reportNormals(FilterResults& results, const LayerPoints& points, bool signs = false)
{
	constexpr double mostlyOpen = 0.5;
	results.flag("normals_estimated", points.estimated.has_value());
	if (!points.estimated) {
		reportGivenNormals(results, points.normalCheck);
		return;
	}
	reportSides(results, *points.estimated);
	if (signs && points.estimated->undecidedShare > mostlyOpen)
		results.warn(
			"The layer has no normals and its surface is open: which side is outside, and so the "
			"sign of the curvatures, is a guess (open_share). To decide it, run Estimate and "
			"Orient Normals (compute_normals_robust_point_cloud) with a viewpoint first.");
}

} // namespace curvature_lines
