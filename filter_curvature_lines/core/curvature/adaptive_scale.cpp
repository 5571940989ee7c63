// Half-sample risk of the candidate scales, for the whole cloud and around every probe.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "adaptive_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "anchor_fits.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "probe_components.h"
#include "progress.h"
#include "quantile.h"
#include "surface_anchors.h"

namespace curvature_lines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Without a source of their own: chosen by experiment on tori, an ellipsoid, a sphere, a cylinder, helicoids and cubes
// with 0 to 2 % noise; benchmarks/curvature.py judges them. docs/method.md, "Scale", has the formulas.

// Candidate radii: from the ball that holds firstCount points (smallestCount in a tiny cloud), the median over
// countedRadii points, up to a share of the bounding-box diagonal, each ladderStep times the one before. With 1.45 or 1.5
// the selection is a third faster and misses the best scale on some clouds.
constexpr Index  firstCount          = 42;
constexpr Index  smallestCount       = 14;
constexpr Index  countedRadii        = 60;
constexpr double ladderStep          = 1.3;
constexpr double largestHeightRadius = 0.22; // unit frame
constexpr double largestNormalRadius = 0.36;
// Clouds of which a share of denseShare is denser than the rest get finer levels, mostFiner at most.
constexpr double denseShare = 0.1;
constexpr double mostFiner  = 12.0;
// quadricResidual is this quantile over so many places: no edge is near that many of them.
constexpr Index  residualPlaces = 256;
constexpr double smoothShare    = 1.0 / 3.0;
// Of a height fit at a probe, each in the frame of the one before.
constexpr int probeIterations = 3;
// Residuals in radii. A scale with a larger median over the probes is not valid; .12 in place of .2 loses the right scales
// at 2 % noise, .4 changes nothing. A ball no thicker than the noisy layer has at least the second one.
constexpr double largestResidual = 0.2;
constexpr double clippedResidual = 0.15;
// Radii: a probe whose points have a mean farther off lies at a rim.
constexpr double rimOffset = 0.12;
constexpr double trim      = 0.05; // share of the terms of a mean that are left out
// A part of the cloud gets scales of its own if it has this many points and probes, and the risk of the best of them is
// less than switchRatio of that of the scale chosen for more points.
constexpr Index  minPoolPoints = 1280;
constexpr Index  minPoolProbes = 32;
constexpr double switchRatio   = 0.5;
constexpr Index errorProbes = 24; // probes around a place whose differences give the variance there
// Probes of a connected part that is treated as a cloud of its own.
constexpr Index minComponent = 128;
// Median over mean of a sum of three squares of normally distributed numbers.
constexpr double medianOfChi2 = 0.79;
// Scales are chosen at every fourth probe, whether finer levels can help is asked at every 32nd: pools of neighbouring
// probes hardly differ.
constexpr Index poolStride     = 4;
constexpr Index hopelessStride = 32;
// Finer levels are given up when the least variance of a level is this many times the best risk of levels that are
// biasLevels coarser; the variance of the next finer level is about five times as large.
constexpr double hopelessRatio = 4.0;
constexpr int    biasLevels    = 3;
constexpr double surelyErrors  = 2.0; // standard errors: a bias of more is certain
// Scales are averaged with weight (least risk / risk)^riskExponent, those above smallestShare, maxMixed at most.
constexpr double      riskExponent  = 4.0;
constexpr double      smallestShare = 0.1;
constexpr std::size_t maxMixed      = 4;

struct Family {
	int    degree;
	double normalRatio; // normalRadius / height.radius
};
// From little bias and much variance to the reverse.
constexpr std::array<Family, 3> families = {{{4, 0.0}, {4, 1.7}, {2, 2.4}}};

using ShapeVector = Eigen::Matrix<double, 6, 1>;

// The components of a symmetric tensor, so that products of vectors are those of tensors.
ShapeVector vectorOf(const Eigen::Matrix3d& shape)
{
	const double twice = std::sqrt(2.0);
	ShapeVector  v;
	v << shape(0, 0), shape(1, 1), shape(2, 2), twice * shape(0, 1), twice * shape(0, 2),
		twice * shape(1, 2);
	return v;
}

struct ProbeEstimate {
	ShapeVector shape    = ShapeVector::Zero();
	double      residual = 0.0; // radii
	double      offset   = 0.0;
	bool        atEdge   = false;
	bool        valid    = false;
};

// One candidate scale on both halves.
struct Trial {
	CurvatureScale                            scale;
	std::array<std::vector<ProbeEstimate>, 2> halves;

	bool valid(Index probe) const { return halves[0][probe].valid && halves[1][probe].valid; }
	bool atEdge(Index probe) const { return halves[0][probe].atEdge || halves[1][probe].atEdge; }
};

std::vector<ProbeEstimate> estimateProbes(
	const SurfaceAnchors*              anchors,
	const std::vector<SurfaceElement>& starts,
	const Eigen::Matrix3Xd&            positions,
	const CurvatureScale&              scale)
{
	std::vector<ProbeEstimate> estimates(starts.size());
	parallelFor(static_cast<Index>(starts.size()), {}, [&](Index p) {
		SurfaceElement element = starts[p];
		if (element.valid && anchors)
			element = anchors->normalField(anchors->onFace(element, positions.col(p)));
		estimates[p] = {
			vectorOf(element.shape),
			starts[p].residual / scale.height.radius,
			starts[p].offset,
			anchors && anchors->nearEdge(positions.col(p)),
			element.valid && (anchors || scale.normalRadius == 0.0)};
	});
	return estimates;
}

double quantileOf(std::vector<double> values, double share)
{
	if (values.empty())
		return infinity;
	return quantileInPlace(values, share);
}

double medianOf(std::vector<double> values)
{
	return quantileOf(std::move(values), 0.5);
}

// Of a few among many, faster than a selection.
void largestLast(std::vector<double>& values, std::size_t count)
{
	std::partial_sort(
		values.rbegin(), values.rbegin() + count, values.rend(), std::greater<double>());
}

// Risk of every trial, from the terms of the probes in `pool`.
class RiskOfPool {
public:
	RiskOfPool(const std::vector<Trial>& trials, const std::vector<Index>& pool) :
			m_trials(trials), m_pool(pool)
	{
		for (const Trial& trial : trials) {
			m_variance.push_back(variance(trial));
			m_residual.push_back(residual(trial));
		}
		dropBelowNoise();
		for (std::size_t c = 0; c < trials.size(); ++c)
			m_risk.push_back(m_variance[c] < infinity ? m_variance[c] + squaredBias(c) : infinity);
	}
	const std::vector<double>& risk() const { return m_risk; }
	const std::vector<double>& variance() const { return m_variance; }
	const std::vector<double>& residual() const { return m_residual; }

private:
	double variance(const Trial& trial) const
	{
		std::vector<double> terms;
		for (const Index p : m_pool)
			if (trial.valid(p))
				terms.push_back(
					0.25 * (trial.halves[0][p].shape - trial.halves[1][p].shape).squaredNorm());
		if (terms.size() < 8 || terms.size() < 0.875 * m_pool.size())
			return infinity;
		const auto kept = static_cast<std::size_t>(std::ceil((1.0 - trim) * terms.size()));
		largestLast(terms, terms.size() - kept);
		return std::accumulate(terms.begin(), terms.begin() + kept, 0.0) / kept;
	}

	double residual(const Trial& trial) const
	{
		std::vector<double> residuals;
		for (const Index p : m_pool)
			for (const auto& half : trial.halves)
				if (half[p].residual > 0.0)
					residuals.push_back(half[p].residual);
		return medianOf(residuals);
	}

	// In a ball no thicker than the noisy layer noise looks like shape. Its residual is large for its radius, and so are
	// those of all finer balls, none of which is valid. (A ball too large for the shape has such a residual as well, but
	// finer ones have not.)
	void dropBelowNoise()
	{
		for (std::size_t c = 0; c < m_trials.size(); ++c) {
			if (!(m_residual[c] > largestResidual))
				continue;
			const CurvatureScale& scale = m_trials[c].scale;
			m_variance[c]               = infinity;
			double smallest             = infinity;
			for (std::size_t q = 0; q < m_trials.size(); ++q)
				if (m_trials[q].scale.family == scale.family &&
				    m_trials[q].scale.level < scale.level)
					smallest = std::min(smallest, m_residual[q]);
			if (smallest < clippedResidual)
				continue;
			for (std::size_t q = 0; q < m_trials.size(); ++q)
				if (m_trials[q].scale.level < scale.level)
					m_variance[q] = infinity;
		}
	}

	// What has less bias than `scale`, and how the radii compare; 1 where neither is known to.
	static double radiusRatio(const CurvatureScale& finer, const CurvatureScale& scale)
	{
		if (finer.family == scale.family)
			return std::min(1.0, finer.height.radius / scale.height.radius);
		const bool less = finer.family < scale.family && finer.level <= scale.level;
		return less ? std::min(1.0, finer.radius() / scale.radius()) : 1.0;
	}

	struct Difference {
		double square = 0.0;
		double error  = infinity; // standard, of the square
	};

	// (T_c - T_q)_A : (T_c - T_q)_B, the squared difference of the biases of two trials: an unbiased estimate
	// because the halves are independent.
	Difference difference(const Trial& trial, const Trial& finer, bool alsoAtEdges) const
	{
		std::vector<double> terms;
		for (const Index p : m_pool)
			if (trial.valid(p) && finer.valid(p) && (alsoAtEdges || !trial.atEdge(p)))
				terms.push_back((trial.halves[0][p].shape - finer.halves[0][p].shape)
				                    .dot(trial.halves[1][p].shape - finer.halves[1][p].shape));
		if (terms.size() < 8)
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
	double squaredBias(std::size_t c) const
	{
		const Trial& trial = m_trials[c];
		const bool   hasEdges =
			std::any_of(m_pool.begin(), m_pool.end(), [&](Index p) { return trial.atEdge(p); });
		double sum = 0.0, precision = 0.0, certain = 0.0;
		for (std::size_t q = 0; q < m_trials.size(); ++q) {
			const Trial& finer = m_trials[q];
			const double ratio = std::pow(radiusRatio(finer.scale, trial.scale), 4);
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

	const std::vector<Trial>& m_trials;
	const std::vector<Index>& m_pool;
	std::vector<double>       m_variance, m_residual, m_risk;
};

std::size_t argmin(const std::vector<double>& values)
{
	return std::min_element(values.begin(), values.end()) - values.begin();
}

// Estimates of about the same risk are better averaged than chosen from.
ScaleMixture mixtureOf(const RiskOfPool& pool)
{
	const std::vector<double>& risk = pool.risk();
	const std::size_t          best = argmin(risk);
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
		mixture.variance += share * pool.variance()[c];
	}
	return mixture;
}

// Of the mixture's estimate at the probes `near` one place: scales are chosen for whole regions, but errors
// differ within them.
double varianceAround(
	const std::vector<Trial>& trials, const std::vector<Index>& near, const ScaleMixture& mixture)
{
	double variance = 0.0;
	for (const auto& [c, share] : mixture.weights) {
		std::vector<double> terms;
		for (const Index p : near)
			if (trials[c].valid(p))
				terms.push_back(
					0.25 *
					(trials[c].halves[0][p].shape - trials[c].halves[1][p].shape).squaredNorm());
		variance += share * (terms.empty() ? mixture.variance : medianOf(terms) / medianOfChi2);
	}
	return variance;
}

std::vector<double> radiiHolding(const PointSample& sample, Index count)
{
	std::vector<double> radii;
	for (Index i = 0; i < std::min<Index>(sample.cloud.size(), countedRadii); ++i) {
		const Eigen::Vector3d position = sample.cloud.positions.col(i);
		const auto            near     = sample.search.nearest(position, count);
		radii.push_back((sample.cloud.positions.col(near.back()) - position).norm());
	}
	return radii;
}

// The residual of quadrics in the smallest balls that reach beyond the noisy layer.
double quadricResidualOf(const PointSample& sample, double smallestRadius, int levels)
{
	double noise = infinity;
	for (int level = 0; level < levels; ++level) {
		const HeightScale   scale{smallestRadius * std::pow(ladderStep, level), 2};
		const PointSubsets  subsets(sample, scale.radius);
		std::vector<double> residuals(std::min<Index>(sample.cloud.size(), residualPlaces));
		parallelFor(static_cast<Index>(residuals.size()), {}, [&](Index p) {
			const SurfaceElement element = surfaceAt(
				subsets,
				p,
				sample.cloud.positions.col(p),
				sample.cloud.normals.col(p),
				scale,
				probeIterations);
			residuals[p] = element.valid ? element.residual : infinity;
		});
		const double residual = quantileOf(residuals, smoothShare);
		noise                 = std::min(noise, residual);
		if (residual < clippedResidual * scale.radius)
			return residual;
	}
	return noise < infinity ? noise : 0.0;
}

// The candidate scales of one level after the other on both halves.
class ScaleTrials {
public:
	ScaleTrials(const PointSample& sample, Index probes, double quadricResidual) :
			m_sample(sample), m_first(blockOf(sample.cloud, 0, sample.cloud.size() / 2)),
			m_second(blockOf(sample.cloud, sample.cloud.size() / 2, sample.cloud.size())),
			m_positions(sample.cloud.positions.leftCols(probes)), m_quadricResidual(quadricResidual)
	{
	}
	const std::vector<Trial>& all() const { return m_trials; }
	const Eigen::Matrix3Xd& positions() const { return m_positions; }

	void run(double radius, int level)
	{
		std::vector<Trial> here;
		for (int f = 0; f < int(families.size()); ++f)
			if (f == 0 || families[f].normalRatio * radius < largestNormalRadius)
				here.push_back(
					{{{radius, families[f].degree}, families[f].normalRatio * radius, f, level},
				     {}});
		for (int h = 0; h < 2; ++h)
			runOnHalf(h, radius, here);
		m_trials.insert(m_trials.end(), here.begin(), here.end());
	}

	// Finer levels cannot win: around all probes asked, everything at `level` varies far more than the
	// best so far errs, or what it fits is noise already.
	bool hopelessBelow(int level) const
	{
		const NeighborSearch search(m_positions);
		std::vector<Index>   everyone(m_positions.cols());
		std::iota(everyone.begin(), everyone.end(), 0);
		if (!hopelessBelow(level, everyone))
			return false;
		for (Index p = 0; p < static_cast<Index>(everyone.size()); p += hopelessStride)
			if (!hopelessBelow(level, search.nearest(m_positions.col(p), minPoolProbes)))
				return false;
		return true;
	}

private:
	// All trials have the same height radius: they share the search and, by degree, the fits.
	void runOnHalf(int h, double radius, std::vector<Trial>& trials) const
	{
		const PointSample& half   = h == 0 ? m_first : m_second;
		const Index        probes = static_cast<Index>(m_positions.cols());
		const PointSubsets subsets(half, radius);
		Degrees            degrees, ofAnchors;
		for (const Trial& trial : trials)
			(trial.scale.height.degree == 2 ? degrees.quadric : degrees.quartic) = true;
		std::vector<HeightFits> fits(probes);
		parallelFor(probes, {}, [&](Index p) {
			fits[p] = surfacesAt(
				subsets,
				p,
				m_positions.col(p),
				m_sample.cloud.normals.col(p),
				radius,
				degrees,
				probeIterations);
		});
		for (Trial& trial : trials) {
			std::vector<double> residuals;
			for (const HeightFits& fit : fits)
				residuals.push_back(fit.of(trial.scale.height.degree).residual / radius);
			trial.scale.usualResidual = quantileOf(residuals, smoothShare) * radius;
			// Scales within the noise are dropped for their residual; anchors are not needed to see that.
			if (trial.scale.normalRadius > 0.0 && quantileOf(residuals, 0.1) < largestResidual)
				(trial.scale.height.degree == 2 ? ofAnchors.quadric : ofAnchors.quartic) = true;
		}
		AnchorFits anchorFits;
		if (ofAnchors.quadric || ofAnchors.quartic)
			anchorFits = fitAnchors(half, subsets, radius, ofAnchors, AnchorDetail::Sketch);
		for (Trial& trial : trials) {
			const int                   degree = trial.scale.height.degree;
			std::vector<SurfaceElement> starts(probes);
			for (Index p = 0; p < probes; ++p) {
				starts[p] = fits[p].of(degree);
				if (isOutlier(starts[p], m_positions.col(p), radius))
					starts[p].valid = false;
			}
			std::unique_ptr<const SurfaceAnchors> anchors;
			if (trial.scale.normalRadius > 0.0 &&
			    (degree == 2 ? ofAnchors.quadric : ofAnchors.quartic))
				anchors = std::make_unique<const SurfaceAnchors>(
					anchorFits, subsets, trial.scale, m_quadricResidual, AnchorDetail::Sketch);
			trial.halves[h] = estimateProbes(anchors.get(), starts, m_positions, trial.scale);
		}
	}

	bool hopelessBelow(int level, const std::vector<Index>& pool) const
	{
		const RiskOfPool risks(m_trials, pool);
		double           best = infinity, least = infinity, residual = infinity, coarser = infinity;
		for (std::size_t c = 0; c < m_trials.size(); ++c) {
			if (m_trials[c].scale.level >= level + biasLevels)
				best = std::min(best, risks.risk()[c]);
			if (m_trials[c].scale.level == level) {
				least    = std::min(least, risks.variance()[c]);
				residual = std::min(residual, risks.residual()[c]);
			}
			if (m_trials[c].scale.level == level + 1)
				coarser = std::min(coarser, risks.residual()[c]);
		}
		const bool noise = residual > largestResidual && coarser < residual;
		return best < infinity && (noise || (least < infinity && least > hopelessRatio * best));
	}

	const PointSample& m_sample;
	const PointSample  m_first, m_second;
	Eigen::Matrix3Xd   m_positions;
	double             m_quadricResidual;
	std::vector<Trial> m_trials;
};

// Probes away from rims; all of them if less than 30 % are. At a rim a fit sees one side only.
std::vector<Index> innerProbes(const std::vector<Trial>& trials, double middleRadius)
{
	const auto off = [&](const Trial& t) {
		return std::abs(std::log(t.scale.height.radius / middleRadius));
	};
	const Trial* near = nullptr;
	for (const Trial& trial : trials)
		if (trial.scale.family == 0 && (!near || off(trial) < off(*near)))
			near = &trial;
	const Index        probes = static_cast<Index>(near->halves[0].size());
	std::vector<Index> inner;
	for (Index p = 0; p < probes; ++p)
		if (0.5 * (near->halves[0][p].offset + near->halves[1][p].offset) < rimOffset)
			inner.push_back(p);
	if (inner.size() < 0.3 * probes) {
		inner.resize(probes);
		std::iota(inner.begin(), inner.end(), 0);
	}
	return inner;
}

} // namespace

ScaleSelection selectScales(
	const PointSample& sample, const AdaptiveScaleOptions& options, const Progress& progress)
{
	const Index n = sample.cloud.size();
	const Index probes =
		std::min(n, std::clamp<Index>(n / 20, options.minProbes, options.maxProbes));
	ScaleSelection            selection;
	const std::vector<double> radii =
		radiiHolding(sample, std::clamp<Index>(n / 4, smallestCount, firstCount));
	selection.usualRadius = medianOf(radii);
	// Parts much denser than the rest have finer levels.
	const double finer = std::min(
		mostFiner,
		std::floor(
			std::log(selection.usualRadius / quantileOf(radii, denseShare)) /
			std::log(ladderStep)));
	const double smallest =
		finer > 1.0 ? selection.usualRadius * std::pow(ladderStep, -finer) : selection.usualRadius;
	const int levels =
		std::max(1, 1 + int(std::log(largestHeightRadius / smallest) / std::log(ladderStep)));

	selection.quadricResidual = quadricResidualOf(sample, smallest, levels);
	ScaleTrials run(sample, probes, selection.quadricResidual);
	for (int level = levels - 1; level >= 0; --level) {
		run.run(smallest * std::pow(ladderStep, level), level);
		progress.report(double(levels - level) / levels);
		if (level > 0 && run.hopelessBelow(level))
			break;
	}
	const std::vector<Trial>& trials = run.all();
	for (const Trial& trial : trials)
		selection.scales.push_back(trial.scale);
	selection.positions = run.positions();

	const std::vector<Index> inner =
		innerProbes(trials, std::sqrt(selection.usualRadius * largestHeightRadius));
	const RiskOfPool whole(trials, inner);
	selection.mixtures.assign(1, mixtureOf(whole));
	if (!(whole.risk()[argmin(whole.risk())] < infinity)) {
		// Too few points for two halves: a quadric through what there is.
		selection.scales.push_back({{selection.usualRadius, 2}, 0.0, 0, 0});
		ScaleMixture only;
		only.weights = {{int(trials.size()), 1.0}};
		selection.mixtures.assign(1, only);
	}
	const std::deque<ProbeComponent> components = connectedComponents(selection.positions, inner);
	std::vector<Index>               componentOf(probes, -1);
	for (std::size_t c = 0; c < components.size(); ++c)
		for (const Index p : components[c].probes())
			componentOf[p] = Index(c);
	const ProbeComponent everyone(selection.positions, inner);
	// From large pools to small ones: the risk of a small pool is uncertain, so it has to be much lower to replace the
	// choice of a larger one.
	const Index smallestPool =
		std::max(minPoolProbes, static_cast<Index>(std::int64_t(minPoolPoints) * probes / n));
	std::vector<RiskOfPool> risksOf;
	for (const ProbeComponent& component : components)
		risksOf.push_back(
			components.size() > 1 && component.size() >= minComponent
				? RiskOfPool(trials, component.probes())
				: whole);
	Eigen::Matrix3Xd asked(3, (probes + poolStride - 1) / poolStride);
	for (Index a = 0; a < asked.cols(); ++a)
		asked.col(a) = selection.positions.col(a * poolStride);
	std::vector<ScaleMixture> mixtures(asked.cols(), selection.mixtures[0]);
	parallelFor(static_cast<Index>(asked.cols()), {}, [&](Index a) {
		const Index           c         = componentOf[everyone.nearest(asked.col(a), 1)[0]];
		const ProbeComponent& component = components[c];
		const RiskOfPool&     base      = risksOf[c];
		std::size_t           chosen    = argmin(base.risk());
		if (components.size() > 1 && base.risk()[chosen] < infinity)
			mixtures[a] = mixtureOf(base);
		for (const Index size : {4 * smallestPool, smallestPool}) {
			if (size >= static_cast<Index>(inner.size()) || 2 * component.size() < size)
				continue;
			const std::vector<Index> pool = component.nearest(asked.col(a), size);
			const RiskOfPool         around(trials, pool);
			const std::size_t        other = argmin(around.risk());
			if (around.risk()[other] < switchRatio * around.risk()[chosen]) {
				chosen      = other;
				mixtures[a] = mixtureOf(around);
			}
		}
	});
	const NeighborSearch probeSearch(run.positions());
	for (Index a = 0; a < asked.cols(); ++a)
		if (whole.risk()[argmin(whole.risk())] < infinity)
			mixtures[a].variance =
				varianceAround(trials, probeSearch.nearest(asked.col(a), errorProbes), mixtures[a]);
	selection.positions = asked;
	selection.mixtures  = std::move(mixtures);
	return selection;
}

} // namespace curvature_lines
