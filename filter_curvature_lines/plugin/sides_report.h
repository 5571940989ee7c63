// What the filters say about the sides of normals that were estimated.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cleaning_report.h"
#include "filter_results.h"
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

} // namespace curvature_lines
