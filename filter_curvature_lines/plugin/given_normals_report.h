// What the filters say about the normals a layer came with.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cleaning_report.h"
#include "filter_results.h"
#include "layer_conversion.h"
#include "normal_check.h"

namespace curvature_lines {

// After the last count("warnings", 0) of the filter.
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

} // namespace curvature_lines
