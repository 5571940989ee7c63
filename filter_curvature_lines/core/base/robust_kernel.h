// The one robust weight of this project (A09 fig. 5b and c).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

// Geman-McClure cost t^2 / (1 + t^2) of a normalised residual t = r / sigma.
inline double gemanMcClureCost(double t)
{
	return t * t / (1.0 + t * t);
}

// Its weight 2 / (1 + t^2)^2, the derivative of the cost divided by t: 2 at 0.
inline double gemanMcClureWeight(double t)
{
	const double one = 1.0 + t * t;
	return 2.0 / (one * one);
}

} // namespace curvature_lines
