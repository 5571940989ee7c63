// The surfaces through a point are found once; how many of their points are accepted changes pass by pass.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_restoration.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "disjoint_sets.h"
#include "outlier_ballot.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "small_surfaces.h"

namespace curvature_lines {

namespace {

constexpr char stage[] = "Restoring points";

// By experiment, as in small_surfaces.cpp.

// Noise in spacings up to which every rejected point is judged again. With more, only where small surfaces are known to be
// better than the voters: where these miss a quarter of the neighbours, too, by more than missDeviation of their height
// errors (noise alone: by 1.15); or, by heights alone, where small surfaces see less than shapeLike of the voters' noise,
// so that the voters take shape for noise. Without these conditions outliers one spacing off a noisy torus are taken back.
constexpr double mostNoise       = 0.1;
constexpr double mostNoiseMissed = 0.25;
constexpr Index  missNeighbors   = 20;
constexpr double missQuantile    = 0.75;
constexpr double missDeviation   = 2.0;
constexpr double mostShapeLike   = 0.35;
constexpr double shapeLike       = 0.6;
// A point's own spacing over that of the voters: sparser than the first, and only surfaces through the most neighbours
// count; sparser than the second (density 1 to 16), and it stays rejected.
constexpr double sparse          = 2.0;
constexpr double sparsest        = 4.0;
constexpr Index  sparseNeighbors = 20;
// Of the members of a surface, those that are accepted; and how many accepted ones are next to the point.
constexpr double      acceptedShare  = 0.25;
constexpr std::size_t acceptedBeside = 3;
// Of the rejected among the so many nearest points this share must have surfaces through them as well, as on a part of the
// shape they have. Without this a fifth of the impulses on half the points of a mesh are taken back.
constexpr Index  companyNeighbors = 20;
constexpr double companyShare     = 0.75;
// The noise around a point is the median over this many accepted points of the so many nearest.
constexpr Index noiseNeighbors = 25, noisePoints = 9;
// Points of a surface of its own: more than a cluster. It touches the accepted points where acceptedBeside of them are
// within this many spacings, at so many of its points.
constexpr std::size_t fewestInPart  = 60;
constexpr double      contact       = 2.4;
constexpr Index       contactPoints = 20; // nearest points looked at
constexpr std::size_t fewestContact = 3;
// A rod has no more than a point or two at its foot. It is no thicker than this: deviation along its second axis, in
// spacings; that of a flat patch with fewestInPart points is 2.2.
constexpr double thickestRod = 1.2;

struct Candidate {
	Index                       point = 0;
	std::vector<PassingSurface> surfaces;
	bool                        judged = false; // small surfaces were asked
	bool inCompany = false; // most of its rejected neighbours have surfaces through them, too
};

class PointRestoration {
public:
	PointRestoration(
		const VoterCloud&           cloud,
		const std::vector<Verdict>& verdicts,
		double                      heightDeviation,
		double                      sensitivity,
		std::vector<char>&          rejected) :
			m_cloud(cloud), m_verdicts(verdicts), m_heightDeviation(heightDeviation),
			m_sensitivity(sensitivity), m_rejected(rejected)
	{
	}

	void run(const Progress& progress);

private:
	double ownSpacing(Index i) const { return spacingOfCrowd * m_cloud.crowding[i]; }
	double votersSpacing(Index i) const
	{
		return m_verdicts[i].spacing > 0.0 ? m_verdicts[i].spacing : ownSpacing(i);
	}
	double distance(Index i, Index j) const
	{
		return (m_cloud.positions.col(i) - m_cloud.positions.col(j)).norm();
	}
	bool votersMiss(Index i) const;
	double noiseAround(Index i, double ofVoters) const;
	void findSurfaces(Candidate& candidate) const;
	void findCandidates(const Progress& progress);
	bool continues(const Candidate& candidate) const;
	bool touches(const Candidate& candidate) const;
	bool isRod(const std::vector<Index>& part) const; // of m_candidates
	template<class Restored>
	bool restoreIf(const Restored& restored);
	bool restoreContinued();
	bool restoreParts();

	const VoterCloud&           m_cloud;
	const std::vector<Verdict>& m_verdicts;
	double                      m_heightDeviation, m_sensitivity;
	std::vector<char>&          m_rejected;
	std::vector<Candidate>      m_candidates; // still rejected, with a surface through each
};

// In spacings. Of accepted points only: what small surfaces see around them is noise.
double PointRestoration::noiseAround(Index i, double ofVoters) const
{
	std::vector<double> deviations;
	for (const Index j : m_cloud.all.nearest(m_cloud.positions.col(i), noiseNeighbors))
		if (!m_rejected[j] && ownSpacing(j) > 0.0 &&
		    static_cast<Index>(deviations.size()) < noisePoints)
			deviations.push_back(smallDeviation(m_cloud, j) / ownSpacing(j));
	return deviations.empty() ? ofVoters : std::min(ofVoters, medianInPlace(deviations));
}

// Whether it is the voters' surface that is wrong here, and not the point.
bool PointRestoration::votersMiss(Index i) const
{
	std::vector<double> deviations;
	for (const Index j : m_cloud.all.nearest(m_cloud.positions.col(i), missNeighbors + 1))
		if (j != i)
			deviations.push_back(
				m_verdicts[j].votes == 0 ? std::numeric_limits<double>::infinity()
										 : m_verdicts[j].deviation);
	return !deviations.empty() && quantileInPlace(deviations, missQuantile) >= missDeviation;
}

void PointRestoration::findSurfaces(Candidate& candidate) const
{
	const Index  i          = candidate.point;
	const double sparseness = ownSpacing(i) / votersSpacing(i);
	if (!(sparseness <= sparsest)) // also when both are 0
		return;
	const double height =
		m_verdicts[i].heightError > 0.0 ? m_verdicts[i].heightError : m_heightDeviation;
	const double ofVoters = height / votersSpacing(i);
	const double noise    = noiseAround(i, ofVoters);
	const bool   all      = noise <= mostNoise || (noise <= mostNoiseMissed && votersMiss(i));
	if (!all && !(noise <= mostShapeLike && noise <= shapeLike * ofVoters))
		return;
	candidate.judged   = true;
	candidate.surfaces = surfacesThrough(m_cloud, i, {noise, m_sensitivity, all});
	if (sparseness > sparse)
		candidate.surfaces.erase(
			std::remove_if(
				candidate.surfaces.begin(),
				candidate.surfaces.end(),
				[](const PassingSurface& surface) { return surface.neighbors < sparseNeighbors; }),
			candidate.surfaces.end());
}

void PointRestoration::findCandidates(const Progress& progress)
{
	std::vector<Index>     at(m_rejected.size(), -1); // among all
	std::vector<Candidate> all;
	for (std::size_t i = 0; i < m_rejected.size(); ++i)
		if (m_rejected[i]) {
			at[i]                    = static_cast<Index>(all.size());
			all.emplace_back().point = static_cast<Index>(i);
		}
	parallelFor(static_cast<Index>(all.size()), progress.sub(0.0, 0.9, stage), [&](Index c) {
		findSurfaces(all[c]);
	});
	parallelFor(static_cast<Index>(all.size()), progress.sub(0.9, 1.0, stage), [&](Index c) {
		double judged = 0.0, passed = 0.0;
		for (const Index j :
		     m_cloud.all.nearest(m_cloud.positions.col(all[c].point), companyNeighbors + 1))
			if (at[j] >= 0 && at[j] != c) {
				judged += all[at[j]].judged;
				passed += !all[at[j]].surfaces.empty();
			}
		all[c].inCompany = passed >= companyShare * judged;
	});
	for (Candidate& candidate : all)
		if (!candidate.surfaces.empty())
			m_candidates.push_back(std::move(candidate));
}

bool PointRestoration::continues(const Candidate& candidate) const
{
	const auto accepted = [&](Index j) { return !m_rejected[j]; };
	return std::any_of(
		candidate.surfaces.begin(), candidate.surfaces.end(), [&](const PassingSurface& surface) {
			const auto on = std::count_if(surface.members.begin(), surface.members.end(), accepted);
			const auto beside =
				std::count_if(surface.joined.begin(), surface.joined.end(), [&](Index j) {
					return accepted(j) && distance(candidate.point, j) <= surface.reach;
				});
			return double(on) >= acceptedShare * double(surface.members.size()) &&
		           static_cast<std::size_t>(beside) >= acceptedBeside;
		});
}

bool PointRestoration::touches(const Candidate& candidate) const
{
	std::size_t  beside  = 0;
	const double spacing = candidate.surfaces.front().spacing;
	for (const Index j : m_cloud.all.nearest(m_cloud.positions.col(candidate.point), contactPoints))
		beside += !m_rejected[j] &&
		          distance(candidate.point, j) <= contact * std::max(spacing, ownSpacing(j));
	return beside >= acceptedBeside;
}

// All are judged on the state before, so that their order does not matter. True when one was restored.
template<class Restored>
bool PointRestoration::restoreIf(const Restored& restored)
{
	std::vector<Index>     points;
	std::vector<Candidate> left;
	for (std::size_t c = 0; c < m_candidates.size(); ++c)
		if (restored(c))
			points.push_back(m_candidates[c].point);
		else
			left.push_back(std::move(m_candidates[c]));
	for (const Index i : points)
		m_rejected[i] = 0;
	m_candidates = std::move(left);
	return !points.empty();
}

bool PointRestoration::isRod(const std::vector<Index>& part) const
{
	std::vector<Index> points;
	double             spacing = 0.0;
	for (const Index c : part) {
		points.push_back(m_candidates[c].point);
		spacing += m_candidates[c].surfaces.front().spacing / double(part.size());
	}
	Eigen::Matrix3Xd positions = columnsOf(m_cloud.positions, points);
	positions.colwise() -= positions.rowwise().mean().eval();
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
	axes.computeDirect(positions * positions.transpose() / double(part.size()));
	return axes.eigenvalues()[1] <= thickestRod * thickestRod * spacing * spacing;
}

bool PointRestoration::restoreContinued()
{
	return restoreIf(
		[&](std::size_t c) { return m_candidates[c].inCompany && continues(m_candidates[c]); });
}

bool PointRestoration::restoreParts()
{
	const auto         count = static_cast<Index>(m_candidates.size());
	std::vector<Index> at(m_rejected.size(), -1);
	for (Index c = 0; c < count; ++c)
		at[m_candidates[c].point] = c;
	DisjointSets parts(count);
	for (Index c = 0; c < count; ++c)
		for (const PassingSurface& surface : m_candidates[c].surfaces)
			for (const Index j : surface.members)
				if (at[j] >= 0)
					parts.join(c, at[j]);
	std::vector<std::size_t>        touching(count, 0);
	std::vector<std::vector<Index>> members(count);
	for (Index c = 0; c < count; ++c) {
		members[parts.find(c)].push_back(c);
		touching[parts.find(c)] += touches(m_candidates[c]);
	}
	std::vector<char> restored(count, 0);
	for (Index part = 0; part < count; ++part)
		restored[part] =
			members[part].size() >= fewestInPart &&
			(touching[part] >= fewestContact || (touching[part] > 0 && isRod(members[part])));
	return restoreIf(
		[&](std::size_t c) { return restored[parts.find(static_cast<Index>(c))] != 0; });
}

void PointRestoration::run(const Progress& progress)
{
	findCandidates(progress);
	while (restoreContinued() || restoreParts()) {
	}
}

} // namespace

void restorePoints(
	const VoterCloud&           cloud,
	const std::vector<Verdict>& verdicts,
	double                      heightDeviation,
	double                      sensitivity,
	std::vector<char>&          rejected,
	const Progress&             progress)
{
	PointRestoration(cloud, verdicts, heightDeviation, sensitivity, rejected).run(progress);
}

} // namespace curvature_lines
