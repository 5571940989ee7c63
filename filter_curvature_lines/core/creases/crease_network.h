// Traced creases as a network: joined over gaps, ended in common corners, evenly resampled. Internal
// to creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "crease_curves.h"
#include "crease_tracing.h"

namespace curvature_lines {

// `traces` as traced with vertices `step` apart; those of the result are `spacing` apart.
Creases creaseNetwork(
	const CreaseTracing& tracing, std::vector<CreaseTrace> traces, double step, double spacing);

} // namespace curvature_lines
