// Noise and radius from leave-one-out residuals of blended patches, and patches that stop at edges.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "robust_denoising.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "patch_blend.h"
#include "shuffled_order.h"

namespace curvature_lines {

namespace {

using Support = BlendOptions::Support;

// Radii in local spacings.
constexpr double smallestRadius  = 2.5; // 20 points: a quadric with some to spare
constexpr double noiseStep       = 1.26;
constexpr double minRadiusNoise  = 5.0; // a patch narrower than this many noise units is all noise
constexpr double freeStep        = 1.4;
constexpr double maxFreeRadius   = 15.0;
constexpr double freeTolerance   = 1.02; // of scores over the best: the end of a ladder
constexpr double bentStep        = 1.12;
constexpr double bentStart       = 0.8; // of the free radius
constexpr double maxBentRadius   = 25.0;
constexpr double bentTolerance   = 1.01;
constexpr double bentTie         = 1.002; // scores that are the same: the wider patch has less variance
constexpr double gatedStep       = 1.3;
constexpr double maxGatedRadius  = 17.0;
constexpr double gatedTolerance  = 1.015;
constexpr double minPilotRadius  = 3.2;
constexpr double pilotNoise      = 8.0; // noise units across which an edge is told from noise
constexpr double maxFlagRadius   = 6.3;
constexpr double fewestPatches   = 6.0; // in a cloud, of n / radius^2 points

constexpr Index  testPoints      = 2000;
constexpr double testOverlap     = 19.0;
constexpr double maxResidual     = 3.0; // noise units, in scores
constexpr double minPurity       = 0.5; // of a point that tells about smooth surfaces
constexpr double minPlainShare   = 0.1;
constexpr double strictPurity    = 2.0;
constexpr double mildPurity      = 1.0;
constexpr double pilotAcceptance = 2.0; // noise units
constexpr double gatedAcceptance = 3.0;
constexpr double sharpPurity     = 0.5; // of smooth patches, below which edges are looked for
constexpr Index  gainNeighbors   = 24;
constexpr double smoothGain      = 0.1; // of a squared residual by gates: below it the gate only costs
constexpr double sharpGain       = 0.3; // above it, it is an edge

double quantile(std::vector<double> values, double share)
{
	const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1));
	std::nth_element(values.begin(), at, values.end());
	return *at;
}

// Side of the square that holds one point.
std::vector<double> localSpacing(const PointCloud& cloud, const Progress& progress)
{
	constexpr Index      k = 16;
	const NeighborSearch search(cloud.positions);
	std::vector<double>  spacing(cloud.size());
	parallelFor(cloud.size(), progress, [&](Index i) {
		const std::vector<Index> near = search.nearest(cloud.positions.col(i), k + 1);
		const double distance = (cloud.positions.col(near.back()) - cloud.positions.col(i)).norm();
		spacing[i]            = distance * std::sqrt(EIGEN_PI / std::max(1.0, near.size() - 1.0));
	});
	return spacing;
}

// The lower quartile belongs to patches off the edges; chi-squared quantile by Wilson and Hilferty.
double noiseOf(const PatchBlend& blend)
{
	if (blend.variance.empty())
		return 0.0;
	const double degrees  = std::max(1.0, quantile(blend.effectiveCount, 0.5) - 6.0);
	const double spread   = 2.0 / (9.0 * degrees);
	const double expected = std::pow(1.0 - spread - 0.6744898 * std::sqrt(spread), 3);
	return std::sqrt(quantile(blend.variance, 0.25) / expected);
}

struct Candidate {
	double              radius = 0.0;
	PatchBlend          blend;
	std::vector<double> loss; // per point: squared leave-one-out residual in noise units, limited
};

class RobustDenoiser {
public:
	RobustDenoiser(const PointCloud& cloud, const RobustDenoisingOptions& options);
	RobustDenoisingResult run(const Progress& progress);

private:
	Index      size() const { return m_input.cloud.size(); }
	void       findNoise(const Progress& progress);
	void       findPlainPoints(const Progress& progress);
	double     freeRadius(const Progress& progress) const;
	double     bentRadius(const BlendGuide& guide, double start, const Progress& progress) const;
	Candidate  smoothCandidate(const Progress& progress) const;
	BlendGuide edgePilot(const std::vector<Index>& targets, const Progress& progress) const;
	Candidate  sharpCandidate(const std::vector<Index>& targets, const Progress& progress) const;
	double     pilotRadius() const;
	bool       fits(double radius) const { return radius * radius * fewestPatches <= size(); }
	Candidate  candidate(
		const BlendGuide&         guide,
		const BlendOptions&       options,
		const std::vector<Index>& targets,
		const Progress&           progress) const;
	double score(const Candidate& candidate, const std::vector<Index>& points) const;

	RobustDenoisingOptions m_options;
	std::vector<Index>     m_order;
	BlendInput             m_input;
	BlendGuide             m_start;            // the input itself
	std::vector<Index>     m_all, m_test;      // points; those that scores are taken from
	std::vector<Index>     m_plain;            // of m_test, off the edges
	double                 m_spacing     = 0.0; // median
	double                 m_noise       = 0.0;
	double                 m_firstRadius = smallestRadius; // where patches are wider than the noise
};

RobustDenoiser::RobustDenoiser(const PointCloud& cloud, const RobustDenoisingOptions& options) :
		m_options(options), m_order(shuffledOrder(cloud.positions))
{
	const Index n = cloud.size();
	m_input.cloud.positions.resize(3, n);
	m_input.cloud.normals.resize(3, n);
	for (Index i = 0; i < n; ++i) {
		m_input.cloud.positions.col(i) = cloud.positions.col(m_order[i]);
		m_input.cloud.normals.col(i)   = cloud.normals.col(m_order[i]);
	}
	m_start = {m_input.cloud.positions, m_input.cloud.normals};
	m_all.resize(n);
	std::iota(m_all.begin(), m_all.end(), 0);
	m_test.assign(m_all.begin(), m_all.begin() + std::min(n, testPoints));
	m_plain = m_test;
}

Candidate RobustDenoiser::candidate(
	const BlendGuide&         guide,
	const BlendOptions&       options,
	const std::vector<Index>& targets,
	const Progress&           progress) const
{
	Candidate c{options.radius, blendPatches(m_input, guide, options, targets, progress), {}};
	c.loss.reserve(size());
	for (Index i = 0; i < size(); ++i) {
		const double e = std::min(std::abs(c.blend.residual[i]) / m_input.noise[i], maxResidual);
		c.loss.push_back(e * e);
	}
	return c;
}

double RobustDenoiser::score(const Candidate& candidate, const std::vector<Index>& points) const
{
	double sum = 0.0;
	for (const Index i : points)
		sum += candidate.loss[i];
	return sum / double(points.size());
}

void RobustDenoiser::findNoise(const Progress& progress)
{
	m_input.noise.assign(size(), m_options.noise);
	m_noise = m_options.noise;
	BlendOptions options;
	options.overlap = testOverlap;
	for (options.radius = smallestRadius;; options.radius *= noiseStep) {
		m_firstRadius = options.radius;
		if (m_options.noise <= 0.0) {
			m_noise = noiseOf(blendPatches(m_input, m_start, options, m_test, progress));
			m_input.noise.assign(size(), m_noise);
		}
		if (m_noise * minRadiusNoise < options.radius * m_spacing || !fits(options.radius * noiseStep))
			return;
	}
}

// Edges would make any wide patch look wrong, and the whole cloud would be smoothed too little.
void RobustDenoiser::findPlainPoints(const Progress& progress)
{
	BlendOptions options;
	options.purity = strictPurity;
	options.radius = std::clamp(
		pilotNoise * m_noise / m_spacing, minPilotRadius, std::max(minPilotRadius, maxFlagRadius));
	options.radius         = std::max(options.radius, m_firstRadius);
	const PatchBlend blend = blendPatches(m_input, m_start, options, m_test, progress);
	std::vector<Index> plain;
	for (const Index i : m_test)
		if (blend.purity[i] > minPurity)
			plain.push_back(i);
	if (double(plain.size()) > minPlainShare * double(m_test.size()))
		m_plain = std::move(plain);
}

double RobustDenoiser::freeRadius(const Progress& progress) const
{
	if (m_options.radius > 0.0)
		return m_options.radius;
	BlendOptions options;
	options.purity  = strictPurity;
	options.overlap = testOverlap;
	double best = std::numeric_limits<double>::infinity(), radius = m_firstRadius;
	for (options.radius = m_firstRadius; options.radius < maxFreeRadius; options.radius *= freeStep) {
		const double s = score(candidate(m_start, options, m_test, progress), m_plain);
		if (s < best)
			radius = options.radius;
		best = std::min(best, s);
		if (s > freeTolerance * best || !fits(options.radius))
			break;
	}
	return radius;
}

double RobustDenoiser::bentRadius(
	const BlendGuide& guide, double start, const Progress& progress) const
{
	if (m_options.radius > 0.0)
		return m_options.radius;
	BlendOptions options;
	options.support = Support::Bent;
	options.purity  = mildPurity;
	options.overlap = testOverlap;
	double best = std::numeric_limits<double>::infinity(), radius = start;
	for (options.radius = start; options.radius < maxBentRadius; options.radius *= bentStep) {
		const double s = score(candidate(guide, options, m_test, progress), m_plain);
		best = std::min(best, s);
		if (s <= bentTie * best)
			radius = options.radius;
		if (s > bentTolerance * best || !fits(options.radius))
			break;
	}
	return radius;
}

Candidate RobustDenoiser::smoothCandidate(const Progress& progress) const
{
	BlendOptions options;
	options.radius = freeRadius(progress.sub(0.0, 0.2, ""));
	options.purity = strictPurity;
	Candidate c    = candidate(m_start, options, m_all, progress.sub(0.2, 0.4, ""));
	options.support = Support::Bent;
	options.purity  = mildPurity;
	double start    = bentStart * options.radius;
	for (int pass = 0; pass < 2; ++pass) {
		const BlendGuide guide{c.blend.positions, c.blend.normals};
		const Progress   part = progress.sub(0.4 + 0.3 * pass, 0.7 + 0.3 * pass, "");
		options.radius        = bentRadius(guide, start, part.sub(0.0, 0.6, ""));
		c                     = candidate(guide, options, m_all, part.sub(0.6, 1.0, ""));
		start                 = options.radius / bentStep;
	}
	return c;
}

double RobustDenoiser::pilotRadius() const
{
	return std::max(m_firstRadius, std::max(minPilotRadius, pilotNoise * m_noise / m_spacing));
}

// A point beside an edge is explained by the pure patches of its own face.
BlendGuide RobustDenoiser::edgePilot(
	const std::vector<Index>& targets, const Progress& progress) const
{
	BlendOptions options;
	options.radius     = pilotRadius();
	options.purity     = strictPurity;
	options.acceptance = pilotAcceptance;
	const PatchBlend free =
		blendPatches(m_input, m_start, options, targets, progress.sub(0.0, 0.5, ""));
	options.support    = Support::Gated;
	options.gateWidth  = m_options.sharpness;
	options.purity     = mildPurity;
	options.acceptance = gatedAcceptance;
	const PatchBlend gated = blendPatches(
		m_input, {free.positions, free.normals}, options, targets, progress.sub(0.5, 1.0, ""));
	return {gated.positions, gated.normals};
}

Candidate RobustDenoiser::sharpCandidate(
	const std::vector<Index>& targets, const Progress& progress) const
{
	BlendGuide   guide = edgePilot(targets, progress.sub(0.0, 0.2, ""));
	BlendOptions options;
	options.support    = Support::Gated;
	options.gateWidth  = m_options.sharpness;
	options.purity     = mildPurity;
	options.acceptance = gatedAcceptance;
	const double last  = m_options.radius > 0.0 ? m_options.radius : maxGatedRadius;
	double       bestScore = std::numeric_limits<double>::infinity();
	Candidate    best;
	for (options.radius = pilotRadius();; options.radius *= gatedStep) {
		Candidate    c = candidate(guide, options, targets, progress.sub(0.2, 1.0, ""));
		const double s = score(c, targets);
		guide = {c.blend.positions, c.blend.normals};
		if (s < bestScore) {
			bestScore = s;
			best      = std::move(c);
		}
		const double next = options.radius * gatedStep;
		if (s > gatedTolerance * bestScore || next > last || !fits(next))
			return best;
	}
}

RobustDenoisingResult RobustDenoiser::run(const Progress& progress)
{
	m_input.spacing = localSpacing(m_input.cloud, progress.sub(0.0, 0.05, "Measuring spacing"));
	m_spacing       = quantile(m_input.spacing, 0.5);
	m_input.spacing.assign(size(), m_spacing);
	findNoise(progress.sub(0.05, 0.1, "Measuring noise"));
	findPlainPoints(progress.sub(0.1, 0.15, "Measuring noise"));
	const Candidate smooth = smoothCandidate(progress.sub(0.15, 0.5, "Fitting smooth patches"));

	RobustDenoisingResult result;
	result.positions.resize(3, size());
	result.normals.resize(3, size());
	result.noise  = m_noise;
	result.radius = smooth.radius;
	std::vector<Index> targets = m_all;
	const Candidate sharp = sharpCandidate(targets, progress.sub(0.5, 0.9, "Fitting patches to edges"));
	const NeighborSearch search(sharp.blend.positions);
	std::vector<double> share(size());
	parallelFor(size(), progress.sub(0.9, 1.0, ""), [&](Index i) {
		const auto& normals = sharp.blend.normals;
		double gain = 0.0, weights = 0.0;
		for (const Index j : search.nearest(sharp.blend.positions.col(i), gainNeighbors)) {
			const double w = std::max(0.0, normals.col(i).dot(normals.col(j)) - 0.5) + 1e-3;
			gain += w * (smooth.loss[j] - sharp.loss[j]);
			weights += w;
		}
		const double t = std::clamp((gain / weights - smoothGain) / (sharpGain - smoothGain), 0.0, 1.0);
		share[i] = t;
		result.positions.col(m_order[i]) = t * sharp.blend.positions.col(i) + (1.0 - t) * smooth.blend.positions.col(i);
		result.normals.col(m_order[i]) = (t * sharp.blend.normals.col(i) + (1.0 - t) * smooth.blend.normals.col(i)).normalized();
	});
	return result;
}

} // namespace

RobustDenoisingResult denoiseRobustly(
	const PointCloud& cloud, const RobustDenoisingOptions& options, const Progress& progress)
{
	RobustDenoisingResult result = RobustDenoiser(cloud, options).run(progress);
	result.rmsMove = std::sqrt((result.positions - cloud.positions).squaredNorm() / cloud.size());
	return result;
}

} // namespace curvature_lines
