// Noise and radius from leave-one-out residuals of blended patches, and patches that stop at edges.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "robust_denoising.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "blended_surface.h"
#include "cloud_index.h"
#include "covering_patch.h"
#include "doubled_layers.h"
#include "move_limit.h"
#include "near_duplicates.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_deviation.h"
#include "progress.h"
#include "quantile.h"
#include "scan_lines.h"

namespace curvature_lines {

namespace {

using Support = BlendOptions::Support;

constexpr const char* stage = "Denoising";

// Constants without a source of their own were chosen by experiment on tori, a helicoid and cubes of 600 to 60 000
// points with 0 to 2 % noise; benchmarks/cleaning.py judges them. Radii are in local spacings, or in units (m_unit) of
// which the cloud has one per spacing in the middle. A ladder tries one radius after the other, each `...Step` times the
// one before, and ends when the score exceeds the best one `...Tolerance` times.
constexpr double smallestRadius = 2.5; // 20 points: a quadric with some to spare
// While the noise is measured radii grow to minRadiusNoise deviations, because in thinner balls noise looks like shape;
// by noiseStep in a round, until less than fewPoints of the points grow by more than noiseSettled.
constexpr double noiseStep      = 1.26;
constexpr double noiseSettled   = 1.02;
constexpr double minRadiusNoise = 5.0;
constexpr double fewPoints      = 0.1;
constexpr double gapsOfNoise =
	1.6; // BlendOptions::gapsAcross: three lines hold the least of the shape
// Patches over tangent planes (Support::Free).
constexpr double freeStep      = 1.4;
constexpr double maxFreeRadius = 15.0;
constexpr double freeTolerance = 1.02;
// Patches by arc length, from a little under the free radius on. Scores within the tie are the same, and of two radii
// with the same score the wider one has less variance.
constexpr double arcStep      = 1.12;
constexpr double arcStart     = 0.8;
constexpr double maxArcRadius = 25.0;
constexpr double arcTolerance = 1.01;
constexpr double arcTie       = 1.001;
// BlendOptions::overlap of blends that a second one corrects: what it cannot correct is their scatter by the choice of
// the patches' centres. With 38 a third more noise is left on lines of 5:1.
constexpr double correctionOverlap = 300.0;
// Patches of one face (Support::OneFace).
constexpr double oneFaceStep      = 1.3;
constexpr double maxOneFaceRadius = 17.0;
constexpr double oneFaceTolerance = 1.015;
// Narrow patches that tell edges from noise: this radius, or pilotNoise deviations; to find out which points are near
// edges no more than maxFlagRadius.
constexpr double minPilotRadius = 3.2;
constexpr double pilotNoise     = 8.0;
constexpr double maxFlagRadius  = 6.3;
// The cloud is no smaller than six patches of these radii, as the sum of radius^2 is at most n^2 / 6.
constexpr double fewestPatches = 6.0;
// Derived: bias grows with the fourth power of the radius, variance as (noise spacing / radius)^2, so that the best
// radius is proportional to (noise spacing)^(1/5).
constexpr double unitExponent = 0.2;

constexpr Index fewestPoints = 8;    // a quadric and a residual
constexpr Index testPoints   = 5000; // that scores are taken from
// Half of BlendOptions::overlap: scores need less than the result.
constexpr double testOverlap = 19.0;
// Deviations: a larger leave-one-out residual counts as this in scores.
constexpr double maxResidual = 3.0;
// Scores leave out points whose patches are less pure than minPurity, if there are edges: if patches are less pure than
// edgePurity at more than fewEdges of the points, and at least minOffEdgeShare of the points remain.
constexpr double minPurity       = 0.5;
constexpr double edgePurity      = 0.01;
constexpr double fewEdges        = 0.01;
constexpr double minOffEdgeShare = 0.1;
// BlendOptions::purity and acceptance of the stages.
constexpr double strictPurity      = 2.0;
constexpr double mildPurity        = 1.0;
constexpr double pilotAcceptance   = 2.0;
constexpr double oneFaceAcceptance = 3.0;
// Points whose smooth patches are less pure are denoised by patches of one face as well. The share of these in the
// result rises from 0 to 1 as they explain more of the squared residuals than smooth ones do: from smoothGain, which
// patches of one face lose by holding fewer points, to sharpGain, which only an edge gives. Compared at gainNeighbors
// points around; those across an edge count next to nothing.
constexpr double sharpPurity   = 0.5;
constexpr double sameSide      = 1e-3;
constexpr Index  gainNeighbors = 24;
constexpr double smoothGain    = 0.1;
constexpr double sharpGain     = 0.3;

// The progress of step k of a ladder: nobody knows how many there are, so that each takes a share of what is left.
Progress rung(const Progress& progress, int k)
{
	constexpr double left = 0.75;
	return progress.sub(1.0 - std::pow(left, k), 1.0 - std::pow(left, k + 1), stage);
}

// Smoothed normals on the side of `normals`, which are in the order of the index: only the side matters to a guide, and
// that of a single normal may be wrong.
Eigen::Matrix3Xd
guideNormals(const CloudIndex& index, const Eigen::Matrix3Xd& normals, const Progress& progress)
{
	Eigen::Matrix3Xd result = index.order().arrange(index.gateNormals(progress));
	for (Index i = 0; i < index.size(); ++i)
		if (normals.col(i).dot(result.col(i)) > 0.0)
			result.col(i) = normals.col(i);
	return result;
}

struct Candidate {
	std::vector<double> radius; // per point, of its patches: a length
	BlendedSurface      blend;
	std::vector<double> loss; // per point: squared leave-one-out residual in noise units, limited
};

// Positions and normals of `first`, with this share of those of `second`.
void mix(
	Candidate&                 first,
	const Candidate&           second,
	const std::vector<double>& share, // per target
	const std::vector<Index>&  targets)
{
	for (std::size_t t = 0; t < targets.size(); ++t) {
		const Index           i = targets[t];
		const Eigen::Vector3d n =
			(1.0 - share[t]) * first.blend.normals.col(i) + share[t] * second.blend.normals.col(i);
		first.blend.positions.col(i) = (1.0 - share[t]) * first.blend.positions.col(i) +
		                               share[t] * second.blend.positions.col(i);
		if (n.norm() > 0.0)
			first.blend.normals.col(i) = n.normalized();
	}
}

class RobustDenoiser {
public:
	// `progress`: of the spacing and of the normals that the first guide needs.
	RobustDenoiser(
		const CloudIndex& index, const RobustDenoisingOptions& options, const Progress& progress);
	RobustDenoisingResult run(const Progress& progress);

private:
	Index size() const { return m_input.cloud.size(); }
	void findPointDeviation(const Progress& progress);
	void findPointsOffEdges(const Progress& progress);
	double freeRadius(const Progress& progress) const;
	double arcRadius(const BlendGuide& guide, double start, const Progress& progress) const;
	Candidate smoothCandidate(const Progress& progress) const;
	void correct(Candidate& smooth, double factor, const Progress& progress) const;
	BlendedSurface edgePilot(
		const Candidate& smooth, const std::vector<Index>& targets, const Progress& progress) const;
	BlendOptions oneFaceOptions(std::vector<double> radius) const;
	Candidate sharpCandidate(
		const Candidate& smooth, const std::vector<Index>& targets, const Progress& progress) const;
	std::vector<double> pilotRadii(const Candidate& smooth) const;
	std::vector<double> shareOfSecond(
		const Candidate& first, const Candidate& second, const std::vector<Index>& targets) const;
	void sharpen(Candidate& smooth, const Progress& progress) const;
	bool fits(const std::vector<double>& radii) const;
	void findUnits();
	std::vector<double> radii(double factor) const; // of units
	std::vector<double> inSpacings(const std::vector<double>& lengths) const;
	Candidate candidate(
		const BlendGuide&         guide,
		const BlendOptions&       options,
		const std::vector<Index>& targets,
		const Progress&           progress) const;
	double score(const Candidate& candidate, const std::vector<Index>& points) const;

	RobustDenoisingOptions m_options;
	BlendInput             m_input;
	BlendGuide             m_start;      // the input itself
	std::vector<Index>     m_everywhere; // all points
	std::vector<Index>     m_test;       // points that scores are taken from
	std::vector<Index>     m_offEdges;   // of m_test, off the edges
	std::vector<double>    m_least;      // radius per point, a length: wider than the noise
	std::vector<double>    m_unit;       // of radii per point, a length
};

RobustDenoiser::RobustDenoiser(
	const CloudIndex& index, const RobustDenoisingOptions& options, const Progress& progress) :
		m_options(options),
		m_input{
			index.order(),
			{index.arrangedPositions(), index.order().arrange(index.cloud().normals)},
			index.spacing(progress.sub(0.0, 0.5, stage)),
			{},
			scanLines(index.arrangedPositions(), index.arrangedSearch(), index.order())},
		m_start(
			m_input.cloud.positions,
			guideNormals(index, m_input.cloud.normals, progress.sub(0.5, 1.0, stage)),
			index.arrangedSearch()),
		m_everywhere(index.size()), m_test(m_input.order.sample(testPoints)), m_offEdges(m_test)
{
	std::iota(m_everywhere.begin(), m_everywhere.end(), 0);
}

std::vector<double> RobustDenoiser::inSpacings(const std::vector<double>& lengths) const
{
	std::vector<double> ratios(lengths.size());
	for (Index i = 0; i < size(); ++i)
		ratios[i] = lengths[i] / m_input.spacing[i];
	return ratios;
}

bool RobustDenoiser::fits(const std::vector<double>& radii) const
{
	double points = 0.0;
	for (const double ratio : inSpacings(radii))
		points += ratio * ratio;
	return points * fewestPatches <= double(size()) * double(size());
}

std::vector<double> RobustDenoiser::radii(double factor) const
{
	std::vector<double> result(size());
	for (Index i = 0; i < size(); ++i)
		result[i] = m_options.radius > 0.0 ? factor * m_input.spacing[i]
		                                   : std::max(factor * m_unit[i], m_least[i]);
	return result;
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
		const double e =
			std::min(std::abs(c.blend.residual[i]) / m_input.pointDeviation[i], maxResidual);
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

void RobustDenoiser::findPointDeviation(const Progress& progress)
{
	m_input.pointDeviation.assign(size(), m_options.noise);
	m_least = m_input.spacing;
	for (double& radius : m_least)
		radius *= smallestRadius;
	BlendOptions options;
	options.overlap    = testOverlap;
	options.gapsAcross = gapsOfNoise;
	for (int k = 0;; ++k) {
		if (m_options.noise <= 0.0) {
			options.radius         = m_least;
			m_input.pointDeviation = pointDeviation(
				blendPatches(m_input, m_start, options, m_test, rung(progress, k)),
				m_input.cloud,
				m_input.order);
		}
		std::vector<double> wider(size());
		Index               grown = 0;
		for (Index i = 0; i < size(); ++i) {
			wider[i] = std::clamp(
				minRadiusNoise * m_input.pointDeviation[i], m_least[i], noiseStep * m_least[i]);
			grown += wider[i] > noiseSettled * m_least[i];
		}
		if (double(grown) <= fewPoints * double(size()) || !fits(wider))
			return;
		m_least = std::move(wider);
	}
}

// One radius in spacings does not suit parts of different noise or density.
void RobustDenoiser::findUnits()
{
	m_unit.resize(size());
	for (Index i = 0; i < size(); ++i)
		m_unit[i] = std::pow(m_input.pointDeviation[i] * m_input.spacing[i], unitExponent);
	const double middle = quantile(inSpacings(m_unit), 0.5);
	for (double& unit : m_unit)
		unit /= middle;
}

// Beside edges every wide patch leaves large residuals. Scores with them would favour small radii everywhere.
void RobustDenoiser::findPointsOffEdges(const Progress& progress)
{
	BlendOptions options;
	options.purity = strictPurity;
	options.radius = m_least;
	for (Index i = 0; i < size(); ++i)
		options.radius[i] = std::max(
			m_least[i],
			std::clamp(
				pilotNoise * m_input.pointDeviation[i],
				minPilotRadius * m_input.spacing[i],
				maxFlagRadius * m_input.spacing[i]));
	const BlendedSurface blend = blendPatches(m_input, m_start, options, m_test, progress);
	std::vector<Index>   offEdges;
	Index                clear = 0;
	for (const Index i : m_test) {
		if (blend.purity[i] > minPurity)
			offEdges.push_back(i);
		clear += blend.purity[i] < edgePurity;
	}
	// Without edges impure points are those with large errors by chance; to leave them out would favour this radius.
	const double share = 1.0 / double(m_test.size());
	if (share * clear > fewEdges && share * double(offEdges.size()) > minOffEdgeShare)
		m_offEdges = std::move(offEdges);
}

double RobustDenoiser::freeRadius(const Progress& progress) const
{
	const double widest = m_options.radius > 0.0 ? m_options.radius : maxFreeRadius;
	BlendOptions options;
	options.purity  = strictPurity;
	options.overlap = testOverlap;
	std::vector<double> first(size());
	for (Index i = 0; i < size(); ++i)
		first[i] = m_least[i] / m_unit[i];
	double factor = quantile(first, fewPoints);
	double best = std::numeric_limits<double>::infinity(), radius = factor;
	for (int k = 0; factor < widest; ++k, factor *= freeStep) {
		options.radius = radii(factor);
		const double s = score(candidate(m_start, options, m_test, rung(progress, k)), m_offEdges);
		if (s < best)
			radius = factor;
		best = std::min(best, s);
		if (s > freeTolerance * best || !fits(options.radius))
			break;
	}
	return radius;
}

double
RobustDenoiser::arcRadius(const BlendGuide& guide, double start, const Progress& progress) const
{
	if (m_options.radius > 0.0)
		return m_options.radius;
	BlendOptions options;
	options.support = Support::ArcLength;
	options.purity  = mildPurity;
	options.overlap = testOverlap;
	double best = std::numeric_limits<double>::infinity(), radius = start;
	for (int k = 0; start < maxArcRadius; ++k, start *= arcStep) {
		options.radius = radii(start);
		const double s = score(candidate(guide, options, m_test, rung(progress, k)), m_offEdges);
		best           = std::min(best, s);
		if (s <= arcTie * best)
			radius = start;
		if (s > arcTolerance * best || !fits(options.radius))
			break;
	}
	return radius;
}

Candidate RobustDenoiser::smoothCandidate(const Progress& progress) const
{
	double       factor = freeRadius(progress.sub(0.0, 0.2, stage));
	BlendOptions options;
	options.radius  = radii(factor);
	options.purity  = strictPurity;
	Candidate c     = candidate(m_start, options, m_everywhere, progress.sub(0.2, 0.4, stage));
	options.support = Support::ArcLength;
	options.purity  = mildPurity;
	double start    = arcStart * factor;
	for (int pass = 0; pass < 2; ++pass) {
		const BlendGuide guide(c.blend.positions, c.blend.normals);
		const Progress   part = progress.sub(0.4 + 0.3 * pass, 0.7 + 0.3 * pass, stage);
		factor                = arcRadius(guide, start, part.sub(0.0, 0.6, stage));
		options.radius        = radii(factor);
		c                     = candidate(guide, options, m_everywhere, part.sub(0.6, 1.0, stage));
		start                 = factor / arcStep;
	}
	if (m_input.lines.any() && m_offEdges.size() == m_test.size())
		correct(c, factor, progress.sub(0.8, 1.0, stage));
	return c;
}

// Across scan lines patches have to be so wide that the shape limits them, not the noise. A second blend, of what the
// first one leaves, allows still wider ones. Patches over an edge do not lose weight here, because purity would take
// the shape of wide ones for an edge: not for clouds with edges, and where it harms, the smooth result stays.
void RobustDenoiser::correct(Candidate& smooth, double factor, const Progress& progress) const
{
	std::vector<Index> test, targets;
	const auto         onLine = [&](Index i) { return m_input.lines.gap[i] > 0.0; };
	std::copy_if(m_offEdges.begin(), m_offEdges.end(), std::back_inserter(test), onLine);
	std::copy_if(m_everywhere.begin(), m_everywhere.end(), std::back_inserter(targets), onLine);
	if (test.empty())
		return;
	const BlendGuide guide(smooth.blend.positions, smooth.blend.normals);
	BlendOptions     options;
	options.overlap  = correctionOverlap;
	double    lowest = std::numeric_limits<double>::infinity();
	Candidate best;
	for (int k = 0;; ++k, factor *= arcStep) {
		const Progress part = rung(progress, k);
		options.radius      = radii(factor);
		options.support     = Support::ArcLength;
		Candidate        c  = candidate(guide, options, m_everywhere, part.sub(0.0, 0.5, stage));
		const BlendGuide flat(std::move(c.blend.positions), std::move(c.blend.normals));
		options.heights = std::move(c.blend.height);
		options.support = Support::Correction;
		c               = candidate(flat, options, m_everywhere, part.sub(0.5, 1.0, stage));
		const double s  = score(c, test);
		if (s < lowest) {
			lowest = s;
			best   = std::move(c);
		}
		if (s > arcTolerance * lowest || m_options.radius > 0.0 || factor > maxArcRadius ||
		    !fits(options.radius))
			break;
	}
	std::vector<double> share = shareOfSecond(best, smooth, targets);
	for (double& s : share)
		s = 1.0 - s;
	mix(smooth, best, share, targets);
	for (const Index i : targets)
		smooth.radius[i] = best.radius[i];
}

std::vector<double> RobustDenoiser::pilotRadii(const Candidate& smooth) const
{
	std::vector<double> result(size());
	for (Index i = 0; i < size(); ++i) {
		const double wide =
			std::max(minPilotRadius * m_input.spacing[i], pilotNoise * m_input.pointDeviation[i]);
		result[i] = std::max(m_least[i], std::min(wide, smooth.radius[i]));
	}
	return result;
}

// Positions and normals as a guide for patches of one face: at the targets from narrow pure patches, elsewhere from the
// smooth surface.
BlendedSurface RobustDenoiser::edgePilot(
	const Candidate& smooth, const std::vector<Index>& targets, const Progress& progress) const
{
	BlendOptions options;
	options.radius     = pilotRadii(smooth);
	options.purity     = strictPurity;
	options.acceptance = pilotAcceptance;
	const BlendedSurface free =
		blendPatches(m_input, m_start, options, targets, progress.sub(0.0, 0.5, stage));
	Eigen::Matrix3Xd positions = smooth.blend.positions, normals = smooth.blend.normals;
	for (const Index i : targets) {
		positions.col(i) = free.positions.col(i);
		normals.col(i)   = free.normals.col(i);
	}
	const BlendGuide guide(std::move(positions), std::move(normals));
	return blendPatches(
		m_input, guide, oneFaceOptions(options.radius), targets, progress.sub(0.5, 1.0, stage));
}

BlendOptions RobustDenoiser::oneFaceOptions(std::vector<double> radius) const
{
	BlendOptions options;
	options.support     = Support::OneFace;
	options.radius      = std::move(radius);
	options.normalWidth = m_options.sharpness;
	options.purity      = mildPurity;
	options.acceptance  = oneFaceAcceptance;
	return options;
}

Candidate RobustDenoiser::sharpCandidate(
	const Candidate& smooth, const std::vector<Index>& targets, const Progress& progress) const
{
	BlendedSurface pilot     = edgePilot(smooth, targets, progress.sub(0.0, 0.2, stage));
	BlendOptions   options   = oneFaceOptions(pilotRadii(smooth));
	const Progress ladder    = progress.sub(0.2, 0.9, stage);
	const double   last      = m_options.radius > 0.0 ? m_options.radius : maxOneFaceRadius;
	double         bestScore = std::numeric_limits<double>::infinity();
	Candidate      best;
	for (int k = 0;; ++k) {
		const BlendGuide guide(pilot.positions, pilot.normals);
		Candidate        c = candidate(guide, options, targets, rung(ladder, k));
		const double     s = score(c, targets);
		pilot              = c.blend;
		if (s < bestScore) {
			bestScore = s;
			best      = std::move(c);
		}
		for (double& radius : options.radius)
			radius *= oneFaceStep;
		if (s > oneFaceTolerance * bestScore || quantile(inSpacings(options.radius), 0.5) > last ||
		    !fits(options.radius))
			break;
	}
	options.radius = best.radius;
	options.edges  = true;
	const BlendGuide guide(best.blend.positions, best.blend.normals);
	best.blend.positions =
		blendPatches(m_input, guide, options, targets, progress.sub(0.9, 1.0, stage)).positions;
	return best;
}

// Share of the second candidate, of patches that stop at edges, in a point: how much better it explains the point and
// its neighbours on the same side of an edge than the first one does.
std::vector<double> RobustDenoiser::shareOfSecond(
	const Candidate& first, const Candidate& second, const std::vector<Index>& targets) const
{
	const auto       n = static_cast<Index>(targets.size());
	Eigen::Matrix3Xd places(3, n);
	for (Index t = 0; t < n; ++t)
		places.col(t) = second.blend.positions.col(targets[t]);
	const NeighborSearch search(places);
	std::vector<double>  share(n);
	parallelFor(n, {}, [&](Index t) {
		const Eigen::Vector3d normal = second.blend.normals.col(targets[t]);
		double                gain = 0.0, weights = 0.0;
		for (const Index k : search.nearest(places.col(t), gainNeighbors)) {
			const Index  j = targets[k];
			const double w = std::max(sameSide, normal.dot(second.blend.normals.col(j)) - 0.5);
			gain += w * (first.loss[j] - second.loss[j]);
			weights += w;
		}
		share[t] = std::clamp((gain / weights - smoothGain) / (sharpGain - smoothGain), 0.0, 1.0);
	});
	return share;
}

void RobustDenoiser::sharpen(Candidate& smooth, const Progress& progress) const
{
	std::vector<Index> targets;
	for (Index i = 0; i < size(); ++i)
		if (smooth.blend.purity[i] < sharpPurity)
			targets.push_back(i);
	if (targets.empty())
		return;
	const Candidate sharp = sharpCandidate(smooth, targets, progress);
	mix(smooth, sharp, shareOfSecond(smooth, sharp, targets), targets);
}

RobustDenoisingResult RobustDenoiser::run(const Progress& progress)
{
	findPointDeviation(progress.sub(0.05, 0.15, stage));
	findUnits();
	findPointsOffEdges(progress.sub(0.15, 0.2, stage));
	Candidate cleaned = smoothCandidate(progress.sub(0.2, 0.7, stage));
	sharpen(cleaned, progress.sub(0.7, 1.0, stage));
	limitMoves(
		m_input.cloud.positions, m_start.search, m_input.pointDeviation, cleaned.blend.positions);
	RobustDenoisingResult result;
	result.positions      = m_input.order.restore(cleaned.blend.positions);
	result.normals        = m_input.order.restore(cleaned.blend.normals);
	result.pointDeviation = quantile(m_input.pointDeviation, 0.5);
	result.radius         = quantile(inSpacings(cleaned.radius), 0.5);
	return result;
}

} // namespace

RobustDenoisingResult denoiseRobustly(
	const CloudIndex& index, const RobustDenoisingOptions& options, const Progress& progress)
{
	// Duplicates count as one point and move as one.
	const NearDuplicates duplicates = nearDuplicates(index, progress.sub(0.0, 0.025, stage));
	const bool           none       = duplicates.groups == index.size();
	const PointCloud     mean       = none ? PointCloud() : meanPoints(index, duplicates);
	const CloudIndex     points     = none ? index : index.moved(mean.positions, mean.normals);
	if (points.size() < fewestPoints)
		return {index.cloud().positions, index.cloud().normals, options.noise, options.radius, 0.0};
	RobustDenoisingResult result =
		RobustDenoiser(points, options, progress.sub(0.025, 0.05, stage)).run(progress);
	if (!none) {
		PointCloud moved =
			placedAroundMeans(index.cloud(), duplicates, mean, {result.positions, result.normals});
		result.positions = std::move(moved.positions);
		result.normals   = std::move(moved.normals);
	}
	result.doubledShare = doubledShare(index, {result.positions, result.normals});
	return result;
}

} // namespace curvature_lines
