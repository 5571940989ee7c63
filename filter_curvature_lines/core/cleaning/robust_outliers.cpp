// Votes of overlapping robust quadrics, repeated without the points they reject.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "robust_outliers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "coordinate_steps.h"
#include "flying_pixels.h"
#include "neighborhoods.h"
#include "outlier_ballot.h"
#include "outlier_groups.h"
#include "outlier_result.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "point_restoration.h"
#include "progress.h"
#include "quantile.h"
#include "sparse_restoration.h"
#include "spatial_order.h"
#include "unstructured_points.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// All chosen by experiment on tori, cubes and helicoids with 0 to 0.5 % noise, far outliers and clusters of 12 points
// beside the surface; benchmarks/cleaning.py judges them now. "Deviations": of the height of points over a
// voter, see OutlierVoter::heightDeviation.

// Points of a voter. A cluster of a dozen outliers is a minority among 150; with 100 a tenth of them less is found.
constexpr Index usualNeighbors  = 150;
constexpr Index fewestNeighbors = 24;  // four times the unknowns of a quadric
constexpr Index mostNeighbors   = 400; // bounds the time on noisy clouds
constexpr Index smallestShare   = 25;  // a voter sees at most 1/25 of the cloud
// Voters that judge a point, on average. Twice as many find no more in twice the time.
constexpr Index  votesPerPoint = 50;
constexpr double minRadius = 7.0; // of a voter in deviations: a thinner ball takes noise for shape
constexpr double neighborGrowth = 1.2; // a voter that wants no more than this is not fitted again
// The number of points per voter is told by this many of them, in so many rounds, as what a quarter of them wants:
// quiet parts of the cloud must not be given more, because larger voters miss detail.
constexpr Index  pilotVoters = 500;
constexpr int    pilotRounds = 2;
constexpr double quietPart   = 0.25;
// Voters around whose deviations make heightDeviation, at least (and at least twice votesPerPoint).
constexpr Index  deviationVoters = 20;
constexpr double overEdgeRatio = 1.5; // own deviation over heightDeviation, of a voter over an edge
// Share of the median number of votes: a point by itself with fewer is isolated.
constexpr double isolatedShare = 0.25;
// Outliers that fill a volume make voters of their own. They are sparse: distance to the 6th neighbour over the median
// of the cloud. And for a surface they are thick: deviation there over that of the cloud, and over the spacing.
constexpr double volumeSparseness = 3.5;
constexpr double volumeDeviation  = 3.0;
constexpr double volumeThickness  = 0.3;
// Points above this share of the sensitivity are doubtful: 1.8 deviations by default. They are rejected with their
// groupSize nearest peers (within a spacing): when these lie on the same side together, by groupSensitivity
// sensitivities of the error of a mean; or in spreadPasses passes when at least minRejectedPeers and the share
// rejectedPeers of them are rejected. Without the passes 5 % less of the clusters is found.
constexpr double doubtfulShare    = 1.8 / 3.5;
constexpr Index  groupSize        = 8;
constexpr double groupSensitivity = 2.0;
constexpr int    spreadPasses     = 3;
constexpr Index  minRejectedPeers = 3;
constexpr double rejectedPeers    = 0.4;
// A cloud that loses this share is looked at for rounded coordinates; spreading these over their steps is believed where
// it leaves so much of the loss at most.
constexpr double suspiciousShare = 0.002;
constexpr double reliefShare     = 0.5;

// Isolation of lone mixed pixels (findLoneMixedPixels) before the votes, and of those that the votes reject.
constexpr double certainIsolation  = 5.0;
constexpr double rejectedIsolation = 1.8;

class RobustVote {
public:
	RobustVote(const CloudIndex& index, double sensitivity, const Progress& progress);
	void rejectFlyingPixels(const Progress& progress); // before the first vote
	// Likewise, per point of the cloud; those that the votes then accept, such as the ground below grass, come back.
	void rejectUntilAccepted(const std::vector<char>& unstructured);
	void rejectAmongUnstructured();
	void fitVoters(const Progress& progress);
	bool vote(const Progress& progress); // true when something changed
	double heightDeviation() const;
	void restoreSurfaces(const Progress& progress);
	OutlierResult result() const;

private:
	void chooseSize(const Progress& progress);
	void placeVoters(Index step);
	void fitPlaced(const Progress& progress);
	void measureHeightDeviation(const Progress& progress);
	void collectVoters();
	void rejectByVerdict(std::vector<char>& rejected);
	void rejectGroups(std::vector<char>& rejected, const Progress& progress) const;
	bool replaceRejected(const std::vector<char>& rejected);
	void addFlying(const std::vector<char>& more);
	void rejectFlying(std::vector<char>& rejected);
	Index neighborsWanted(const OutlierVoter& voter) const;
	Index size() const { return static_cast<Index>(m_positions.cols()); }

	const CloudIndex      m_index;
	const SpatialOrder&   m_order;
	const Matrix3Xd&      m_positions; // in this order, as everything below
	const NeighborSearch& m_search;
	double                m_sensitivity;
	std::vector<double>   m_crowding;
	Index                 m_largest, m_neighbors;

	std::vector<OutlierVoter> m_voters;
	std::vector<char>         m_stale;    // voters to be fitted again
	NeighborLists             m_votersOf; // of each point
	std::vector<Verdict>      m_verdicts;
	std::vector<char>         m_rejected;
	std::vector<char>         m_flying;       // rejected whatever the votes say
	std::vector<char>         m_unstructured; // rejected until the votes accept them
	Index                     m_isolated = 0;
};

RobustVote::RobustVote(const CloudIndex& index, double sensitivity, const Progress& progress) :
		m_index(index), m_order(index.order()), m_positions(index.arrangedPositions()),
		m_search(index.arrangedSearch()), m_sensitivity(sensitivity), m_crowding(size()),
		m_largest(std::max(fewestNeighbors, size() / smallestShare)),
		m_neighbors(std::min(usualNeighbors, m_largest)), m_verdicts(size()), m_rejected(size(), 0),
		m_flying(size(), 0)
{
	parallelFor(size(), progress.sub(0.0, 0.5, "Finding neighbors"), [&](Index i) {
		const auto nearest = m_search.nearest(m_positions.col(i), crowdSize + 1);
		m_crowding[i]      = (m_positions.col(nearest.back()) - m_positions.col(i)).norm();
	});
	chooseSize(progress.sub(0.5, 1.0, "Measuring the noise"));
}

// How many points a voter needs is told before the first round: larger voters are fewer, and none is fitted twice.
void RobustVote::chooseSize(const Progress& progress)
{
	for (int round = 0; round < pilotRounds && m_largest > neighborGrowth * m_neighbors; ++round) {
		placeVoters(std::max<Index>(1, size() / pilotVoters));
		fitPlaced(progress.sub(0.5 * round, 0.5 * (round + 1), "Measuring the noise"));
		std::vector<double> wanted;
		wanted.reserve(m_voters.size());
		for (const OutlierVoter& voter : m_voters)
			wanted.push_back(neighborsWanted(voter));
		m_voters.clear();
		const auto enough = static_cast<Index>(quantileInPlace(wanted, quietPart));
		if (enough == m_neighbors)
			break;
		m_neighbors = enough;
	}
}

Index RobustVote::neighborsWanted(const OutlierVoter& voter) const
{
	if (!voter.surface.valid)
		return voter.neighbors;
	const double radius = minRadius * voter.heightDeviation / voter.spacing;
	const double inside = EIGEN_PI * radius * radius;
	const auto   wanted =
		static_cast<Index>(std::min(inside, double(std::min(mostNeighbors, m_largest))));
	return wanted > neighborGrowth * voter.neighbors ? wanted : voter.neighbors;
}

// One voter at every `step`-th point of the shuffled order, and one at every point rejected before: few others judge
// points far from everything.
void RobustVote::placeVoters(Index step)
{
	std::vector<Index> voterAt(size(), -1);
	for (std::size_t v = 0; v < m_voters.size(); ++v)
		voterAt[m_voters[v].centre] = static_cast<Index>(v);
	std::vector<OutlierVoter> voters;
	std::vector<char>         stale;
	for (Index i = 0; i < size(); ++i) {
		if (m_order.rank[i] % step != 0 && !m_rejected[i])
			continue;
		if (voterAt[i] < 0) {
			voters.emplace_back();
			voters.back().centre    = i;
			voters.back().neighbors = m_neighbors;
			stale.push_back(1);
			continue;
		}
		voters.push_back(std::move(m_voters[voterAt[i]]));
		const Index wanted = neighborsWanted(voters.back());
		stale.push_back(m_stale[voterAt[i]] || wanted != voters.back().neighbors);
		voters.back().neighbors = wanted;
	}
	m_voters = std::move(voters);
	m_stale  = std::move(stale);
}

void RobustVote::fitVoters(const Progress& progress)
{
	placeVoters(std::max<Index>(1, m_neighbors / votesPerPoint));
	fitPlaced(progress);
}

void RobustVote::fitPlaced(const Progress& progress)
{
	std::vector<Index> active;
	for (Index i = 0; i < size(); ++i)
		if (!m_rejected[i])
			active.push_back(i);
	const Matrix3Xd      activePositions = columnsOf(m_positions, active);
	const NeighborSearch activeSearch(activePositions);
	const VoterCloud cloud{m_positions, m_crowding, m_order.rank, m_search, active, activeSearch};
	parallelFor(
		static_cast<Index>(m_voters.size()),
		progress.sub(0.0, 0.9, "Fitting surfaces"),
		[&](Index v) {
			if (m_stale[v])
				fitVoter(m_voters[v], cloud);
		});
	measureHeightDeviation(progress.sub(0.9, 1.0, "Measuring the noise"));
}

void RobustVote::measureHeightDeviation(const Progress& progress)
{
	std::vector<double> deviations;
	std::vector<Index>  accepted;
	for (std::size_t v = 0; v < m_voters.size(); ++v)
		if (m_voters[v].surface.valid && !m_rejected[m_voters[v].centre])
			accepted.push_back(static_cast<Index>(v));
	Matrix3Xd origins(3, accepted.size());
	for (std::size_t k = 0; k < accepted.size(); ++k) {
		origins.col(k) = m_voters[accepted[k]].surface.origin;
		deviations.push_back(m_voters[accepted[k]].deviation());
	}
	const NeighborSearch search(origins);
	const Index          around = std::max(deviationVoters, 2 * votesPerPoint);
	parallelFor(static_cast<Index>(m_voters.size()), progress, [&](Index v) {
		OutlierVoter& voter = m_voters[v];
		if (!voter.surface.valid)
			return;
		thread_local std::vector<double> near;
		near.clear();
		for (const Index k : search.nearest(voter.surface.origin, around))
			near.push_back(deviations[k]);
		voter.heightDeviation = near.empty() ? voter.deviation() : medianInPlace(near);
		voter.overEdge        = voter.deviation() > overEdgeRatio * voter.heightDeviation;
	});
}

void RobustVote::collectVoters()
{
	std::vector<Index>& offsets = m_votersOf.offsets;
	offsets.assign(size() + 1, 0);
	for (const OutlierVoter& voter : m_voters)
		for (const Index i : voter.ball)
			++offsets[i + 1];
	for (Index i = 0; i < size(); ++i)
		offsets[i + 1] += offsets[i];
	m_votersOf.indices.resize(offsets.back());
	std::vector<Index> next(offsets.begin(), offsets.end() - 1);
	for (std::size_t v = 0; v < m_voters.size(); ++v)
		for (const Index i : m_voters[v].ball)
			m_votersOf.indices[next[i]++] = static_cast<Index>(v);
}

void RobustVote::rejectByVerdict(std::vector<char>& rejected)
{
	if (size() == 0)
		return;
	std::vector<double> counts, crowding = m_crowding;
	for (const Verdict& verdict : m_verdicts)
		counts.push_back(verdict.votes);
	const double fewest   = isolatedShare * medianInPlace(counts);
	const double noCrowd  = volumeSparseness * medianInPlace(crowding);
	const double tooThick = volumeDeviation * heightDeviation();
	m_isolated            = 0;
	for (Index i = 0; i < size(); ++i) {
		Verdict&   verdict = m_verdicts[i];
		const bool volume  = m_crowding[i] > noCrowd && verdict.heightError > tooThick &&
		                    verdict.heightError > volumeThickness * verdict.spacing;
		const bool isolated =
			verdict.votes == 0 || volume || (verdict.lonely && verdict.votes < fewest);
		if (isolated)
			verdict.against = 1.0;
		m_isolated += isolated;
		rejected[i] = isolated || verdict.deviation > m_sensitivity;
	}
}

// A deviation that is common for one point is improbable for a group: noise would have to move all of it to the same
// side. And a point most of whose neighbours were rejected belongs to their cluster.
void RobustVote::rejectGroups(std::vector<char>& rejected, const Progress& progress) const
{
	std::vector<Index> doubtful;
	for (Index i = 0; i < size(); ++i)
		if (!rejected[i] && m_verdicts[i].deviation > doubtfulShare * m_sensitivity)
			doubtful.push_back(i);
	std::vector<std::vector<Index>> peers(doubtful.size());
	parallelFor(static_cast<Index>(doubtful.size()), progress, [&](Index d) {
		const Index    i = doubtful[d];
		const Vector3d p = m_positions.col(i);
		for (const Index j : m_search.nearest(p, groupSize + 1))
			if (j != i && (m_positions.col(j) - p).norm() < m_verdicts[i].spacing)
				peers[d].push_back(j);
	});
	for (std::size_t d = 0; d < doubtful.size(); ++d) {
		const Verdict& verdict = m_verdicts[doubtful[d]];
		Vector3d       sum     = verdict.toSurface;
		for (const Index j : peers[d])
			sum += m_verdicts[j].toSurface;
		const double error = verdict.heightError * std::sqrt(peers[d].size() + 1.0);
		rejected[doubtful[d]] =
			sum.dot(verdict.toSurface.normalized()) > groupSensitivity * m_sensitivity * error;
	}
	for (int pass = 0; pass < spreadPasses; ++pass) {
		const std::vector<char> before = rejected;
		for (std::size_t d = 0; d < doubtful.size(); ++d) {
			const auto found = std::count_if(
				peers[d].begin(), peers[d].end(), [&](Index j) { return before[j] != 0; });
			if (found >= minRejectedPeers && found >= rejectedPeers * double(peers[d].size()))
				rejected[doubtful[d]] = 1;
		}
	}
}

// Voters that lose or regain a point have to be fitted again. True when there are such, or voters that
// want more points.
bool RobustVote::replaceRejected(const std::vector<char>& rejected)
{
	bool changed = false;
	m_stale.assign(m_voters.size(), 0);
	for (Index i = 0; i < size(); ++i) {
		if (rejected[i] == m_rejected[i])
			continue;
		changed = true;
		for (const Index v : m_votersOf[i])
			m_stale[v] = 1;
	}
	m_rejected = rejected;
	return changed || std::any_of(m_voters.begin(), m_voters.end(), [&](const OutlierVoter& voter) {
			   return neighborsWanted(voter) != voter.neighbors;
		   });
}

// Voters fitted before, to measure the noise, have seen them.
void RobustVote::rejectFlyingPixels(const Progress& progress)
{
	const VoterCloud cloud{m_positions, m_crowding, m_order.rank, m_search, {}, m_search};
	m_flying = findFlyingPixels(cloud, progress.sub(0.0, 0.5, "Finding flying pixels"));
	const std::vector<char> all(size(), 1);
	addFlying(findLoneMixedPixels(
		cloud, all, certainIsolation, progress.sub(0.5, 1.0, "Finding flying pixels")));
	rejectFlying(m_rejected);
}

void RobustVote::rejectUntilAccepted(const std::vector<char>& unstructured)
{
	m_unstructured.resize(size());
	for (Index i = 0; i < size(); ++i) {
		m_unstructured[i] = unstructured[m_order.source[i]];
		m_rejected[i] |= m_unstructured[i];
	}
}

void RobustVote::addFlying(const std::vector<char>& more)
{
	for (Index i = 0; i < size(); ++i)
		m_flying[i] |= more[i];
}

void RobustVote::rejectFlying(std::vector<char>& rejected)
{
	for (Index i = 0; i < size(); ++i)
		if (m_flying[i]) {
			rejected[i]           = 1;
			m_verdicts[i].against = 1.0;
		}
}

bool RobustVote::vote(const Progress& progress)
{
	collectVoters();
	parallelFor(size(), progress.sub(0.0, 0.9, "Voting"), [&](Index i) {
		thread_local Ballot ballot;
		ballot.clear();
		const Vector3d p = m_positions.col(i);
		for (const Index v : m_votersOf[i])
			addVote(ballot, m_voters[v], m_positions.col(m_voters[v].centre), p);
		m_verdicts[i] = countVotes(ballot, m_crowding[i], m_sensitivity);
	});
	std::vector<char> rejected(size(), 0);
	rejectByVerdict(rejected);
	rejectGroups(rejected, progress.sub(0.9, 1.0, "Voting"));
	rejectFlying(rejected);
	return replaceRejected(rejected);
}

// Small surfaces would take many of a volume of points back, and of what lies among them.
void RobustVote::rejectAmongUnstructured()
{
	if (m_unstructured.empty())
		return;
	parallelFor(size(), {}, [&](Index i) {
		if (!m_rejected[i])
			return;
		const auto near  = m_search.nearest(m_positions.col(i), groupSize + 1);
		const auto count = std::count_if(
			near.begin(), near.end(), [&](Index j) { return m_unstructured[j] && m_rejected[j]; });
		if (m_unstructured[i] || count >= minRejectedPeers)
			m_flying[i] = 1;
	});
}

void RobustVote::restoreSurfaces(const Progress& progress)
{
	const VoterCloud cloud{m_positions, m_crowding, m_order.rank, m_search, {}, m_search};
	addFlying(findLoneMixedPixels(
		cloud, m_rejected, rejectedIsolation, progress.sub(0.0, 0.2, "Finding flying pixels")));
	rejectAmongUnstructured();
	restoreGroups(
		cloud,
		m_verdicts,
		heightDeviation(),
		m_sensitivity,
		m_rejected,
		progress.sub(0.2, 0.5, "Restoring groups"));
	restorePoints(
		cloud,
		m_verdicts,
		heightDeviation(),
		m_sensitivity,
		m_rejected,
		progress.sub(0.5, 0.9, "Restoring points"));
	if (const Matrix3Xd& normals = m_index.cloud().normals; normals.cols() == m_positions.cols())
		restoreSparseSurfaces(
			cloud,
			normals(Eigen::all, m_order.source),
			m_flying,
			m_rejected,
			progress.sub(0.9, 1.0, "Restoring sparse surfaces"));
	rejectFlying(m_rejected);
}

double RobustVote::heightDeviation() const
{
	std::vector<double> deviations;
	for (const OutlierVoter& voter : m_voters)
		if (voter.surface.valid)
			deviations.push_back(voter.heightDeviation);
	return deviations.empty() ? 0.0 : medianInPlace(deviations);
}

OutlierResult RobustVote::result() const
{
	OutlierResult result;
	result.outlier.resize(size());
	result.score.resize(size());
	for (Index i = 0; i < size(); ++i) {
		result.outlier[m_order.source[i]] = m_rejected[i];
		result.score[m_order.source[i]]   = m_verdicts[i].against;
	}
	result.isolated        = m_isolated;
	result.heightDeviation = heightDeviation();
	return result;
}

OutlierResult rejectOnce(
	const CloudIndex&        index,
	double                   sensitivity,
	Index                    rounds,
	const std::vector<char>& unstructured, // may be empty
	const Progress&          progress)
{
	RobustVote  votes(index, sensitivity, progress.sub(0.0, 0.04, "Finding neighbors"));
	const Index most = std::max<Index>(rounds, 1);
	votes.rejectFlyingPixels(progress.sub(0.04, 0.05, "Finding flying pixels"));
	if (!unstructured.empty())
		votes.rejectUntilAccepted(unstructured);
	Index used = 0;
	for (bool changed = true; changed && used < most; ++used) {
		const Progress part = progress.sub(
			0.05 + 0.9 * used / most, 0.05 + 0.9 * (used + 1) / most, "Rejecting outliers");
		votes.fitVoters(part.sub(0.0, 0.8, "Fitting surfaces"));
		changed = votes.vote(part.sub(0.8, 1.0, "Voting"));
	}
	votes.restoreSurfaces(progress.sub(0.95, 1.0, "Restoring groups"));
	OutlierResult result = votes.result();
	result.roundsUsed    = used;
	return result;
}

Index countOf(const OutlierResult& result)
{
	return static_cast<Index>(std::count(result.outlier.begin(), result.outlier.end(), char(1)));
}

// Where most heights are equal because they were rounded, the voters' deviation is that of one layer, and all other layers
// look like outliers.
OutlierResult rejectRounded(
	const CloudIndex&        index,
	double                   sensitivity,
	Index                    rounds,
	const std::vector<char>& unstructured,
	const Progress&          progress)
{
	OutlierResult first = rejectOnce(
		index, sensitivity, rounds, unstructured, progress.sub(0.0, 0.5, "Rejecting outliers"));
	if (double(countOf(first)) <= suspiciousShare * double(index.size()))
		return first;
	std::vector<double>     spacing = index.spacing();
	const SpreadCoordinates spread =
		spreadOverSteps(index.cloud().positions, medianInPlace(spacing));
	if (!spread.any())
		return first;
	OutlierResult second = rejectOnce(
		index.moved(spread.positions, index.cloud().normals),
		sensitivity,
		rounds,
		unstructured,
		progress.sub(0.5, 1.0, "Rejecting outliers"));
	return double(countOf(second)) > reliefShare * double(countOf(first)) ? first : second;
}

} // namespace

OutlierResult rejectByRobustVotes(
	const CloudIndex& index,
	double            sensitivity,
	Index             rounds,
	const Progress&   progress,
	bool              rejectUnstructured)
{
	if (!rejectUnstructured) {
		OutlierResult result     = rejectRounded(index, sensitivity, rounds, {}, progress);
		result.unstructuredShare = unstructuredShare(index, result.outlier);
		return result;
	}
	const std::vector<char> unstructured =
		findUnstructured(index, progress.sub(0.0, 0.2, "Finding hair and grass"));
	OutlierResult result = rejectRounded(
		index, sensitivity, rounds, unstructured, progress.sub(0.2, 1.0, "Rejecting outliers"));
	Index count = 0;
	for (Index i = 0; i < index.size(); ++i)
		count += unstructured[i] && result.outlier[i];
	result.unstructuredShare = double(count) / std::max<double>(1.0, double(index.size()));
	return result;
}

double voterHeightDeviation(const CloudIndex& index, const Progress& progress)
{
	RobustVote votes(index, 0.0, progress.sub(0.0, 0.1, "Measuring the noise"));
	votes.fitVoters(progress.sub(0.1, 1.0, "Measuring the noise"));
	return votes.heightDeviation();
}

} // namespace curvature_lines
