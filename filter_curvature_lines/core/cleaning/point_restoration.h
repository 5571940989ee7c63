// Rejected points judged once more, one by one: tips, rods, rims, fillets and sparse parts are narrower than the patches
// of the vote and those of its groups.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "outlier_ballot.h"
#include "outlier_voter.h"
#include "progress.h"

namespace curvature_lines {

// Points are taken back, pass by pass, where a small surface passes through them and runs on into accepted points. What is
// left is taken back where it is a surface of its own that touches the accepted points and is no cluster: a rod whose
// foot is a corner. Not where the noise is such that small surfaces cannot tell it from outliers.
// `cloud.active` is not looked at; `verdicts` are of the vote that rejected.
void restorePoints(
	const VoterCloud&           cloud,
	const std::vector<Verdict>& verdicts,
	double                      heightDeviation, // where a verdict has no heightError
	double                      sensitivity,
	std::vector<char>&          rejected,
	const Progress&             progress = {});

} // namespace curvature_lines
