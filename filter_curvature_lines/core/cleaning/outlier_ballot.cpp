// A coherent minority of the votes accepts a point: a mean shift from the least distances.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_ballot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "outlier_voter.h"
#include "point_cloud.h"
#include "surface_patch.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Weights of votes. Voters over an edge count only where there is no other. Those whose points end before the judged one
// (Support::Rim) tell whether it has company, not where the surface is. Both by experiment: cubes and helicoids without
// outliers, benchmarks/cleaning.py "Selected though there are no outliers".
constexpr double overEdgeWeight = 1e-4;
constexpr double rimWeight      = 0.1;
// Share of the votes that suffices to accept a point (A09: half of them). At corners two thirds of the voters know other
// faces: 0.2 rejected .14 to .26 % of a clean cube, .05 at most .1 %. And for a point by itself this number of votes.
constexpr double acceptance       = 0.05;
constexpr int    lonelyAcceptance = 3;
// A point is by itself when its 6th neighbour is farther than this many spacings; in a right-angled corner it is at 2.8.
constexpr double lonelyDistance = 3.0;
// Votes within this many height errors of each other are about one surface; the mean shift converges in four steps.
constexpr double coherence  = 1.5;
constexpr int    meanShifts = 4;

// Vector from the point to the surface that a small share of the votes accepts; at a corner no more of them belong to
// the point's face. The smallest of many distances is biased to zero, so the mean of the votes that agree is taken.
Vector3d surfaceOf(const Ballot& ballot, bool lonely)
{
	double      passed = 0.0;
	std::size_t least  = lonely ? lonelyAcceptance - 1 : 0;
	std::size_t k      = 0;
	for (; k + 1 < ballot.votes.size(); ++k) {
		passed += ballot.votes[k].weight;
		if (passed >= acceptance * ballot.weight && k >= least)
			break;
	}
	Vector3d     toSurface = ballot.votes[k].toSurface;
	const double reach     = coherence * ballot.heightError;
	for (int step = 0; step < meanShifts; ++step) {
		Vector3d sum    = Vector3d::Zero();
		double   weight = 0.0;
		for (const Vote& vote : ballot.votes)
			if ((vote.toSurface - toSurface).squaredNorm() <= reach * reach) {
				sum += vote.weight * vote.toSurface;
				weight += vote.weight;
			}
		if (!(weight > 0.0))
			break;
		toSurface = sum / weight;
	}
	return toSurface;
}

} // namespace

void addVote(Ballot& ballot, const OutlierVoter& voter, const Vector3d& centre, const Vector3d& p)
{
	const SurfacePatch::Local   local   = voter.surface.toLocal(p);
	const OutlierVoter::Support support = voter.support(local);
	if (support == OutlierVoter::Support::Outside)
		return;
	const double radius  = voter.surface.radius;
	const double falling = 1.0 - 0.9 * (p - centre).squaredNorm() / (radius * radius);
	const double near    = falling * falling;
	const double r       = voter.surface.residual(local);
	const bool   rim     = support == OutlierVoter::Support::Rim;
	const double weight  = near * (voter.overEdge ? overEdgeWeight : rim ? rimWeight : 1.0);
	ballot.heightError += near * voter.heightError();
	ballot.spacing += near * voter.spacing;
	ballot.nearness += near;
	ballot.proper |= !rim && !voter.overEdge;
	(rim ? ballot.rimWeight : ballot.weight) += weight;
	(rim ? ballot.rim : ballot.votes)
		.push_back({std::abs(r), weight, -r * voter.surface.normal(local.x, local.y)});
}

Verdict countVotes(Ballot& ballot, double crowding, double sensitivity)
{
	Verdict verdict;
	if (!(ballot.nearness > 0.0))
		return verdict;
	ballot.heightError /= ballot.nearness;
	verdict.heightError = ballot.heightError;
	verdict.spacing     = ballot.spacing / ballot.nearness;
	verdict.lonely      = crowding > lonelyDistance * verdict.spacing;
	if (verdict.lonely && !ballot.proper)
		return verdict;
	if (!verdict.lonely) {
		ballot.votes.insert(ballot.votes.end(), ballot.rim.begin(), ballot.rim.end());
		ballot.weight += ballot.rimWeight;
	}
	verdict.votes = static_cast<Index>(ballot.votes.size());
	if (verdict.votes == 0)
		return verdict;
	std::sort(ballot.votes.begin(), ballot.votes.end(), [](const Vote& a, const Vote& b) {
		return a.distance < b.distance;
	});
	verdict.toSurface = surfaceOf(ballot, verdict.lonely);
	verdict.deviation = verdict.toSurface.norm() / verdict.heightError;
	double against    = 0.0;
	for (const Vote& vote : ballot.votes)
		if (vote.distance > sensitivity * verdict.heightError)
			against += vote.weight;
	verdict.against = std::clamp(against / ballot.weight, 0.0, 1.0);
	return verdict;
}

} // namespace curvature_lines
