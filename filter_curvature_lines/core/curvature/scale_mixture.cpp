// Shares by risk.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_mixture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "half_sample_risk.h"
#include "point_cloud.h"
#include "quantile.h"
#include "scale_trials.h"

namespace curvature_lines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// By the experiments that adaptive_scale.cpp tells of: scales are averaged with weight (least risk / risk)^riskExponent,
// those above smallestShare, maxMixed at most.
constexpr double      riskExponent  = 4.0;
constexpr double      smallestShare = 0.1;
constexpr std::size_t maxMixed      = 4;
// Median over mean of a sum of three squares of normally distributed numbers.
constexpr double medianOfChi2 = 0.79;

} // namespace

ScaleMixture mixtureOf(const HalfSampleRisk& risks)
{
	const std::vector<double>& risk = risks.risk();
	const std::size_t          best = risks.best();
	ScaleMixture               mixture;
	double                     total = 0.0;
	for (std::size_t c = 0; c < risk.size(); ++c) {
		const double share =
			risk[c] > risk[best] ? std::pow(risk[best] / risk[c], riskExponent) : 1.0;
		if (risk[c] < infinity && share > smallestShare)
			mixture.weights.emplace_back(int(c), share);
	}
	std::stable_sort(
		mixture.weights.begin(), mixture.weights.end(), [](const auto& a, const auto& b) {
			return a.second > b.second;
		});
	if (mixture.weights.size() > maxMixed)
		mixture.weights.resize(maxMixed);
	for (const auto& [c, share] : mixture.weights)
		total += share;
	for (auto& [c, share] : mixture.weights) {
		share /= total;
		mixture.variance += share * risks.variance()[c];
	}
	return mixture;
}

double varianceAround(
	const std::vector<ScaleTrial>& trials,
	const std::vector<Index>&      near,
	const ScaleMixture&            mixture)
{
	double variance = 0.0;
	for (const auto& [c, share] : mixture.weights) {
		std::vector<double> terms;
		for (const Index p : near)
			if (trials[c].valid(p))
				terms.push_back(trials[c].variance(p));
		variance +=
			share * (terms.empty() ? mixture.variance : medianInPlace(terms) / medianOfChi2);
	}
	return variance;
}

} // namespace curvature_lines
