// What the filters say about clouds that cleaning cannot make good.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

#include "filter_results.h"

namespace curvature_lines {

// "about 12 % of the points"
inline std::string aboutShare(double share)
{
	return "about " + std::to_string(std::lround(100.0 * share)) + " % of the points";
}

// `share`: RobustDenoisingResult::doubledShare. Less than a twentieth, as the hooves of a cow of 2903 points have, goes without
// a sentence.
inline void reportDoubledLayers(FilterResults& results, double share)
{
	constexpr double told = 0.05;
	results.real("doubled_share", share);
	if (share > told)
		results.warn(
			"The surface is there twice around " + aboutShare(share) +
			" (doubled_share): layers less than about a spacing apart have become one between "
			"them, others are left. Check the registration of the scans.");
}

// `share`: OutlierResult::unstructuredShare.
inline void reportUnstructured(FilterResults& results, double share, bool rejected)
{
	constexpr double told = 0.1;
	results.real("unstructured_share", share);
	if (share > told && !rejected)
		results.warn(
			"No surface goes through " + aboutShare(share) +
			" (unstructured_share), as with hair, grass and foliage. They are kept; "
			"'reject_unstructured' rejects them.");
}

} // namespace curvature_lines
