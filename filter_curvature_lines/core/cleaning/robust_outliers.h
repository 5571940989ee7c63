// Outliers by the votes of overlapping robust quadrics: the vote of A09 section 4.1 with voters of more
// points than a cluster of outliers has, and with height in place of normals, which outliers spoil.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// OutlierOptions::Mode::Robust. The vote looks at positions only; normals, where there are some, bring
// sparse parts of the surface back (sparse_restoration.h). The same for any order of the points.
OutlierResult rejectByRobustVotes(
	const CloudIndex& index, // unit frame
	double            sensitivity,
	Index             rounds,
	const Progress&   progress           = {},
	bool              rejectUnstructured = false); // unstructured_points.h

// OutlierResult::heightDeviation without a vote.
double voterHeightDeviation(const CloudIndex& index, const Progress& progress = {});

} // namespace curvature_lines
