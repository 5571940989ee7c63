// The table of filters, in the order of the method.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_table.h"

namespace curvature_lines {

const std::vector<FilterSpec>& filterTable()
{
	static const std::vector<FilterSpec> table = {
		robustCurvatureFilter(),
		selectOutliersFilter(),
		denoiseFilter(),
		smoothDirectionsFilter(),
		traceLinesFilter(),
		quadMeshFilter(),
		reconstructionFilter(),
		mWeightedCurvatureFilter(),
		projectionFilter(),
		rayTraceFilter(),
		sharpFeaturesFilter(),
	};
	return table;
}

} // namespace curvature_lines
