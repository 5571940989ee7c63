// The one robust weight of this project (A09 fig. 5b and c), and the robust deviation that goes with it.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

// Standard deviation of normally distributed residuals over the median of their absolute values,
// 1 / Phi^-1(3/4) with Phi the distribution function of the normal distribution (A09 after eq. 1).
constexpr double deviationOverMedian = 1.4826;

// Geman-McClure cost t^2 / (1 + t^2) of a normalised residual t = r / sigma.
inline double gemanMcClureCost(double t)
{
	return t * t / (1.0 + t * t);
}

// (1 + t^2)^2 for t^2: what a weight of 1 is divided by.
inline double gemanMcClureDivisor(double squared)
{
	const double one = 1.0 + squared;
	return one * one;
}

// Its weight 2 / (1 + t^2)^2, the derivative of the cost divided by t: 2 at 0.
inline double gemanMcClureWeight(double t)
{
	return 2.0 / gemanMcClureDivisor(t * t);
}

// The weight over that of a residual of 0, from t^2: 1 at 0, 1/4 at t = 1.
inline double relativeGemanMcClureWeight(double squared)
{
	return 1.0 / gemanMcClureDivisor(squared);
}

} // namespace curvature_lines
