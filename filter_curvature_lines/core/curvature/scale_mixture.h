// How much an estimate at one place relies on each candidate scale: scales of about the same risk are better averaged than
// chosen from. Internal to adaptive_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "half_sample_risk.h"
#include "point_cloud.h"
#include "scale_trials.h"

namespace curvature_lines {

struct ScaleMixture {
	// (index of the candidate scale, share), the largest first; the shares add up to 1
	std::vector<std::pair<int, double>> weights;
	double                              variance = 0.0; // of the shape operator, 1/length^2
};

// The shares fall with the risk. Empty if no scale is valid.
ScaleMixture mixtureOf(const HalfSampleRisk& risks);

// Variance of the mixture's estimate at the probes `near` one place, 1/length^2: scales are chosen for whole regions, but
// errors differ within them.
double varianceAround(
	const std::vector<ScaleTrial>& trials,
	const std::vector<Index>&      near,
	const ScaleMixture&            mixture);

} // namespace curvature_lines
