// The table of filters, in the order of the method.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_table.h"

#include <vector>

namespace curvature_lines {

// Each in a file of its own, filter_*.cpp.
FilterSpec estimateNormalsFilter();
FilterSpec robustCurvatureFilter();
FilterSpec selectOutliersFilter();
FilterSpec denoiseFilter();
FilterSpec smoothDirectionsFilter();
FilterSpec traceLinesFilter();
FilterSpec sharpFeaturesFilter();
FilterSpec quadMeshFilter();
FilterSpec reconstructionFilter();
FilterSpec mWeightedCurvatureFilter();
FilterSpec projectionFilter();
FilterSpec rayTraceFilter();

const std::vector<FilterSpec>& filterTable()
{
	static const std::vector<FilterSpec> table = {
		estimateNormalsFilter(),
		robustCurvatureFilter(),
		selectOutliersFilter(),
		denoiseFilter(),
		smoothDirectionsFilter(),
		traceLinesFilter(),
		sharpFeaturesFilter(),
		quadMeshFilter(),
		reconstructionFilter(),
		mWeightedCurvatureFilter(),
		projectionFilter(),
		rayTraceFilter(),
	};
	return table;
}

} // namespace curvature_lines

// For programs that load the plugin but are no host, such as the Python package: a line per filter, the Python name and
// the summary with a tab between them. Hosts have no place for summaries.
extern "C" Q_DECL_EXPORT const char* curvature_lines_filters()
{
	static const QByteArray text = [] {
		QString lines;
		for (const curvature_lines::FilterSpec& filter : curvature_lines::filterTable())
			lines += filter.pythonName + '\t' + filter.summary + '\n';
		return lines.toUtf8();
	}();
	return text.constData();
}
