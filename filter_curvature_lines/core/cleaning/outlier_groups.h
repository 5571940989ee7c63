// Rejected groups judged again by smaller voters: tips and ridges are narrower than the voters of the first vote.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "outlier_ballot.h"
#include "outlier_voter.h"
#include "progress.h"

namespace curvature_lines {

// Points of large groups are taken back where small voters see one surface run on from the accepted points
// into the group. Neither a cluster of outliers nor a patch beside the surface is: their edge is a step.
// `cloud.active` is not looked at; `verdicts` are of the vote that rejected.
void restoreGroups(
	const VoterCloud&           cloud,
	const std::vector<Verdict>& verdicts,
	double                      heightDeviation, // where a verdict has no heightError
	double                      sensitivity,
	std::vector<char>&          rejected,
	const Progress&             progress = {});

} // namespace curvature_lines
