// A coherent minority of the votes accepts a point: a mean shift from the least distances.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_ballot.h"

#include <algorithm>
#include <cmath>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Voters that see an edge count only where there is no other; those that end before the point have a say
// about its company, which at rims and corners others know even less.
constexpr double overEdgeWeight   = 1e-4;
constexpr double rimWeight        = 0.1;
constexpr double acceptance       = 0.05; // a point is good if this share of its votes says so,
constexpr int    lonelyAcceptance = 3;    // and for a point by itself this number of votes
// spacings to the 6th neighbour; in a right-angled corner it is at 2.8
constexpr double lonelyDistance = 3.0;
constexpr double coherence      = 1.5; // noise units within which votes speak of one surface
constexpr int    meanShifts     = 4;

// The surface accepted by a small share of the votes, which at a corner is all that know the face, and from
// there to the mean of the votes that agree, because the least of many distances is too optimistic.
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
