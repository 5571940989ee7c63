// Trimmed means over a pool of probes of products of estimates from the two halves.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_sample_risk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "point_cloud.h"
#include "quantile.h"
#include "scale_ladder.h"
#include "scale_trials.h"
#include "surface_anchors.h"

namespace curvature_lines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// By the experiments that adaptive_scale.cpp tells of.
constexpr double      trim        = 0.05; // share of the terms of a mean that are left out
constexpr std::size_t fewestTerms = 8;    // of a mean
constexpr double mostlyValid  = 0.875; // share of the pool at which a scale has to have an estimate
constexpr double surelyErrors = 2.0;   // standard errors: a bias of more is certain

// Of a few among many, faster than a selection.
void largestLast(std::vector<double>& values, std::size_t count)
{
	std::partial_sort(
		values.rbegin(), values.rbegin() + count, values.rend(), std::greater<double>());
}

// How the radii compare if `finer` has less bias than `scale`; 1 if that is not known.
double radiusRatio(const CurvatureScale& finer, const CurvatureScale& scale)
{
	if (finer.family == scale.family)
		return std::min(1.0, finer.height.radius / scale.height.radius);
	const bool less = finer.family < scale.family && finer.level <= scale.level;
	return less ? std::min(1.0, finer.radius() / scale.radius()) : 1.0;
}

} // namespace

HalfSampleRisk::HalfSampleRisk(
	const std::vector<ScaleTrial>& trials, const std::vector<Index>& pool) :
		m_trials(trials), m_pool(pool)
{
	m_variance.reserve(trials.size());
	m_residual.reserve(trials.size());
	m_risk.reserve(trials.size());
	for (const ScaleTrial& trial : trials) {
		m_variance.push_back(variance(trial));
		m_residual.push_back(residual(trial));
	}
	dropBelowNoise();
	for (std::size_t c = 0; c < trials.size(); ++c)
		m_risk.push_back(m_variance[c] < infinity ? m_variance[c] + squaredBias(c) : infinity);
}

std::size_t HalfSampleRisk::best() const
{
	return std::min_element(m_risk.begin(), m_risk.end()) - m_risk.begin();
}

double HalfSampleRisk::variance(const ScaleTrial& trial) const
{
	std::vector<double> terms;
	for (const Index p : m_pool)
		if (trial.valid(p))
			terms.push_back(trial.variance(p));
	if (terms.size() < fewestTerms || terms.size() < mostlyValid * m_pool.size())
		return infinity;
	const auto kept = static_cast<std::size_t>(std::ceil((1.0 - trim) * terms.size()));
	largestLast(terms, terms.size() - kept);
	return std::accumulate(terms.begin(), terms.begin() + kept, 0.0) / kept;
}

double HalfSampleRisk::residual(const ScaleTrial& trial) const
{
	std::vector<double> residuals;
	for (const Index p : m_pool)
		for (const auto& half : trial.halves)
			if (half[p].residual > 0.0)
				residuals.push_back(half[p].residual);
	return residuals.empty() ? infinity : medianInPlace(residuals);
}

// In a ball no thicker than the noisy layer noise looks like shape. Its residual is large for its radius, and so are
// those of all finer balls, none of which is valid. (A ball too large for the shape has such a residual as well, but
// finer ones have not.)
void HalfSampleRisk::dropBelowNoise()
{
	for (std::size_t c = 0; c < m_trials.size(); ++c) {
		if (!(m_residual[c] > largestResidual))
			continue;
		const CurvatureScale& scale = m_trials[c].scale;
		m_variance[c]               = infinity;
		double smallest             = infinity;
		for (std::size_t q = 0; q < m_trials.size(); ++q)
			if (m_trials[q].scale.family == scale.family && m_trials[q].scale.level < scale.level)
				smallest = std::min(smallest, m_residual[q]);
		if (smallest < clippedResidual)
			continue;
		for (std::size_t q = 0; q < m_trials.size(); ++q)
			if (m_trials[q].scale.level < scale.level)
				m_variance[q] = infinity;
	}
}

// (T_c - T_q)_A : (T_c - T_q)_B, the squared difference of the biases of two trials: an unbiased estimate
// because the halves are independent.
HalfSampleRisk::Difference
HalfSampleRisk::difference(const ScaleTrial& trial, const ScaleTrial& finer, bool alsoAtEdges) const
{
	std::vector<double> terms;
	for (const Index p : m_pool)
		if (trial.valid(p) && finer.valid(p) && (alsoAtEdges || !trial.atEdge(p)))
			terms.push_back((trial.halves[0][p].shape - finer.halves[0][p].shape)
			                    .dot(trial.halves[1][p].shape - finer.halves[1][p].shape));
	if (terms.size() < fewestTerms)
		return {};
	const auto cut = static_cast<std::size_t>(0.5 * trim * terms.size());
	std::partial_sort(terms.begin(), terms.begin() + cut, terms.end());
	largestLast(terms, cut);
	const auto count = static_cast<double>(terms.size() - 2 * cut);
	double     total = 0.0, squares = 0.0;
	for (std::size_t t = cut; t < terms.size() - cut; ++t) {
		total += terms[t];
		squares += terms[t] * terms[t];
	}
	const double mean = total / count;
	return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count + 1e-30)};
}

// Bias grows with the fourth power of the radius: every finer scale q gives an estimate
// difference / (1 - (r_q / r_c)^4)^2 of the squared bias at c. They are averaged by their precision.
// The law does not hold for detail that c smooths away whole: what a much finer scale sees counts alone
// where it is beyond doubt and more than a half errs there. (Beside an edge it is the finer one that errs.)
double HalfSampleRisk::squaredBias(std::size_t c) const
{
	const ScaleTrial& trial = m_trials[c];
	const bool        hasEdges =
		std::any_of(m_pool.begin(), m_pool.end(), [&](Index p) { return trial.atEdge(p); });
	double sum = 0.0, precision = 0.0, certain = 0.0;
	for (std::size_t q = 0; q < m_trials.size(); ++q) {
		const ScaleTrial& finer = m_trials[q];
		const double      ratio = std::pow(radiusRatio(finer.scale, trial.scale), 4);
		if (ratio > 0.5 || !(m_variance[q] < infinity))
			continue;
		const double     share = (1.0 - ratio) * (1.0 - ratio);
		const Difference all   = difference(trial, finer, true);
		if (!(all.error < infinity))
			continue;
		const double weight = share * share / (all.error * all.error);
		sum += weight * all.square / share;
		precision += weight;
		const Difference smooth = hasEdges ? difference(trial, finer, false) : all;
		if (smooth.error < infinity)
			certain = std::max(
				certain,
				(smooth.square - surelyErrors * smooth.error - 2.0 * m_variance[q]) / share);
	}
	return precision > 0.0 ? std::max(certain, sum / precision) : 0.0;
}

} // namespace curvature_lines
