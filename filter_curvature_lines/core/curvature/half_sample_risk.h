// The risk of candidate scales without the truth: the two halves of a trial are independent, so that their difference gives
// the variance of an estimate, and what they agree on when scales are compared gives the bias. Internal to
// adaptive_scale; docs/method.md, "Scale", has the formulas.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "point_cloud.h"
#include "scale_trials.h"

namespace curvature_lines {

// Means over the probes in a pool. Refers to the trials and to the pool.
class HalfSampleRisk {
public:
	HalfSampleRisk(const std::vector<ScaleTrial>& trials, const std::vector<Index>& pool);

	// Per trial, of the estimate from all points, 1/length^2; infinite where the scale is not valid: it has too few
	// estimates, or lies within the noise. Variance plus squared bias:
	const std::vector<double>& risk() const { return m_risk; }
	const std::vector<double>& variance() const { return m_variance; }
	// Per trial: median of the residuals, in radii.
	const std::vector<double>& residual() const { return m_residual; }

	// The trial with the least risk.
	std::size_t best() const;
	double leastRisk() const { return m_risk[best()]; }

private:
	struct Difference {
		double square = 0.0;
		double error  = std::numeric_limits<double>::infinity(); // standard, of the square
	};

	double variance(const ScaleTrial& trial) const;
	double residual(const ScaleTrial& trial) const;
	void dropBelowNoise();
	Difference difference(const ScaleTrial& trial, const ScaleTrial& finer, bool alsoAtEdges) const;
	double squaredBias(std::size_t c) const;

	const std::vector<ScaleTrial>& m_trials;
	const std::vector<Index>&      m_pool;
	std::vector<double>            m_variance, m_residual, m_risk;
};

} // namespace curvature_lines
