// Trials from coarse to fine as long as finer ones can win, then a mixture of scales for every region, from large regions
// to small ones.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "adaptive_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "half_sample_risk.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "probe_components.h"
#include "progress.h"
#include "scale_ladder.h"
#include "scale_mixture.h"
#include "scale_trials.h"

namespace curvature_lines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The constants of the selection, here and in scale_ladder, scale_trials, half_sample_risk and scale_mixture, were chosen
// by experiment on tori, an ellipsoid, a sphere, a cylinder, helicoids and cubes with 0 to 2 % noise, unless they say
// otherwise; benchmarks/curvature.py judges them. docs/method.md, "Scale", has the formulas.

// Radii: a probe whose points have a mean farther off lies at a rim.
constexpr double rimOffset = 0.12;
// All probes count if less than this share of them is away from rims.
constexpr double fewestInner = 0.3;
// A part of the cloud gets scales of its own if it has this many points and probes, and the risk of the best of them is
// less than switchRatio of that of the scale chosen for more points.
constexpr Index  minPoolPoints = 1280;
constexpr Index  minPoolProbes = 32;
constexpr double switchRatio   = 0.5;
constexpr Index errorProbes = 24; // probes around a place whose differences give the variance there
// Probes of a connected part that is treated as a cloud of its own.
constexpr Index minComponent = 128;
// Scales are chosen at every fourth probe, whether finer levels can help is asked at every 32nd: pools of neighbouring
// probes hardly differ.
constexpr Index poolStride     = 4;
constexpr Index hopelessStride = 32;
// Finer levels are given up when the least variance of a level is this many times the best risk of levels that are
// biasLevels coarser; the variance of the next finer level is about five times as large.
constexpr double hopelessRatio = 4.0;
constexpr int    biasLevels    = 3;

// Whether nothing finer than `level` can win in the pool: everything at `level` varies far more than the best so far errs,
// or what it fits is noise already.
bool hopelessBelow(int level, const std::vector<ScaleTrial>& trials, const std::vector<Index>& pool)
{
	const HalfSampleRisk risks(trials, pool);
	double               best = infinity, least = infinity, residual = infinity, coarser = infinity;
	for (std::size_t c = 0; c < trials.size(); ++c) {
		if (trials[c].scale.level >= level + biasLevels)
			best = std::min(best, risks.risk()[c]);
		if (trials[c].scale.level == level) {
			least    = std::min(least, risks.variance()[c]);
			residual = std::min(residual, risks.residual()[c]);
		}
		if (trials[c].scale.level == level + 1)
			coarser = std::min(coarser, risks.residual()[c]);
	}
	const bool noise = residual > largestResidual && coarser < residual;
	return best < infinity && (noise || (least < infinity && least > hopelessRatio * best));
}

std::vector<Index> allProbes(Index count)
{
	std::vector<Index> probes(count);
	std::iota(probes.begin(), probes.end(), 0);
	return probes;
}

// In the whole cloud, and around all probes asked.
bool hopelessBelow(int level, const ScaleTrials& trials)
{
	const auto probes = static_cast<Index>(trials.positions().cols());
	if (!hopelessBelow(level, trials.all(), allProbes(probes)))
		return false;
	const NeighborSearch search(trials.positions());
	for (Index p = 0; p < probes; p += hopelessStride)
		if (!hopelessBelow(
				level, trials.all(), search.nearest(trials.positions().col(p), minPoolProbes)))
			return false;
	return true;
}

// Probes away from rims; all of them if too few are. At a rim a fit sees one side only.
std::vector<Index> innerProbes(const std::vector<ScaleTrial>& trials, double middleRadius)
{
	const auto off = [&](const ScaleTrial& t) {
		return std::abs(std::log(t.scale.height.radius / middleRadius));
	};
	const ScaleTrial* near = nullptr;
	for (const ScaleTrial& trial : trials)
		if (trial.scale.family == 0 && (!near || off(trial) < off(*near)))
			near = &trial;
	const Index        probes = static_cast<Index>(near->halves[0].size());
	std::vector<Index> inner;
	for (Index p = 0; p < probes; ++p)
		if (0.5 * (near->halves[0][p].offset + near->halves[1][p].offset) < rimOffset)
			inner.push_back(p);
	return inner.size() < fewestInner * probes ? allProbes(probes) : inner;
}

// The best scales around a place: those of the whole cloud, of the connected part it belongs to, or of the probes nearest to
// it. From large pools to small ones: the risk of a small pool is uncertain, so it has to be much lower to replace the
// choice of a larger one.
class RegionalScales {
public:
	// Refers to the trials and to `inner`, the probes that count. `points`: of the cloud that the probes are taken from.
	// `fallback`: for a cloud in which no scale is valid.
	RegionalScales(
		const ScaleTrials&        trials,
		const std::vector<Index>& inner,
		Index                     points,
		const ScaleMixture&       fallback);

	// Whether any scale is, in the whole cloud.
	bool valid() const { return m_valid; }
	ScaleMixture around(const Eigen::Vector3d& place) const;

private:
	ScaleMixture chosenAround(const Eigen::Vector3d& place) const;

	const std::vector<ScaleTrial>&   m_trials;
	const std::vector<Index>&        m_inner;
	const NeighborSearch             m_search; // over all probes
	const HalfSampleRisk             m_whole;
	const bool                       m_valid;
	const ScaleMixture               m_ofWhole; // or the fallback
	const std::deque<ProbeComponent> m_components;
	std::vector<HalfSampleRisk>      m_ofComponents;
	std::vector<Index>               m_componentOf; // per probe; -1: it does not count
	const ProbeComponent             m_everyone;
	Index                            m_smallestPool = minPoolProbes;
};

RegionalScales::RegionalScales(
	const ScaleTrials&        trials,
	const std::vector<Index>& inner,
	Index                     points,
	const ScaleMixture&       fallback) :
		m_trials(trials.all()), m_inner(inner), m_search(trials.positions()),
		m_whole(m_trials, inner), m_valid(m_whole.leastRisk() < infinity),
		m_ofWhole(m_valid ? mixtureOf(m_whole) : fallback),
		m_components(connectedComponents(trials.positions(), inner)),
		m_componentOf(trials.positions().cols(), -1), m_everyone(trials.positions(), inner)
{
	const auto probes = static_cast<std::int64_t>(trials.positions().cols());
	m_smallestPool = std::max(minPoolProbes, static_cast<Index>(minPoolPoints * probes / points));
	m_ofComponents.reserve(m_components.size());
	for (std::size_t c = 0; c < m_components.size(); ++c) {
		const ProbeComponent& component = m_components[c];
		m_ofComponents.push_back(
			m_components.size() > 1 && component.size() >= minComponent
				? HalfSampleRisk(m_trials, component.probes())
				: m_whole);
		for (const Index p : component.probes())
			m_componentOf[p] = static_cast<Index>(c);
	}
}

ScaleMixture RegionalScales::around(const Eigen::Vector3d& place) const
{
	ScaleMixture mixture = chosenAround(place);
	if (m_valid)
		mixture.variance = varianceAround(m_trials, m_search.nearest(place, errorProbes), mixture);
	return mixture;
}

ScaleMixture RegionalScales::chosenAround(const Eigen::Vector3d& place) const
{
	const Index           c         = m_componentOf[m_everyone.nearest(place, 1)[0]];
	const ProbeComponent& component = m_components[c];
	const HalfSampleRisk& base      = m_ofComponents[c];
	std::size_t           chosen    = base.best();
	ScaleMixture          mixture =
        m_components.size() > 1 && base.leastRisk() < infinity ? mixtureOf(base) : m_ofWhole;
	for (const Index size : {4 * m_smallestPool, m_smallestPool}) {
		if (size >= static_cast<Index>(m_inner.size()) || 2 * component.size() < size)
			continue;
		const std::vector<Index> pool = component.nearest(place, size);
		const HalfSampleRisk     near(m_trials, pool);
		if (near.leastRisk() < switchRatio * near.risk()[chosen]) {
			chosen  = near.best();
			mixture = mixtureOf(near);
		}
	}
	return mixture;
}

} // namespace

ScaleSelection selectScales(
	const PointSample& sample, const AdaptiveScaleOptions& options, const Progress& progress)
{
	const Index n = sample.cloud.size();
	const Index probes =
		std::min(n, std::clamp<Index>(n / 20, options.minProbes, options.maxProbes));
	const ScaleLadder ladder = scaleLadder(sample);
	ScaleSelection    selection;
	selection.usualRadius     = ladder.usualRadius;
	selection.quadricResidual = quadricResidual(sample, ladder);

	ScaleTrials trials(sample, probes, selection.quadricResidual);
	for (int level = ladder.levels - 1; level >= 0; --level) {
		trials.run(ladder.radius(level), level);
		progress.report(double(ladder.levels - level) / ladder.levels);
		if (level > 0 && hopelessBelow(level, trials))
			break;
	}
	selection.scales.reserve(trials.all().size() + 1);
	for (const ScaleTrial& trial : trials.all())
		selection.scales.push_back(trial.scale);

	// Where two halves have too few points for any scale: a quadric through what there is.
	ScaleMixture fallback;
	fallback.weights = {{static_cast<int>(selection.scales.size()), 1.0}};

	const std::vector<Index> inner = innerProbes(trials.all(), ladder.middleRadius());
	const RegionalScales     scales(trials, inner, n, fallback);
	if (!scales.valid())
		selection.scales.push_back({{ladder.usualRadius, 2}, 0.0, 0, 0});
	selection.positions = trials.positions()(Eigen::all, Eigen::seq(0, probes - 1, poolStride));
	selection.mixtures.resize(selection.positions.cols());
	parallelFor(static_cast<Index>(selection.mixtures.size()), {}, [&](Index a) {
		selection.mixtures[a] = scales.around(selection.positions.col(a));
	});
	return selection;
}

} // namespace curvature_lines
