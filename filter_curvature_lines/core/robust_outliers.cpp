// Votes of overlapping robust quadrics, repeated without the points they reject.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "robust_outliers.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "shuffled_order.h"
#include "surface_patch.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Index  usualNeighbors   = 150; // a cluster of outliers is a minority among so many
constexpr Index  fewestNeighbors  = 24;
constexpr Index  mostNeighbors    = 400;
constexpr Index  smallestShare    = 25;  // a voter sees at most this part of the cloud
constexpr Index  votesPerPoint    = 50;
constexpr double minNoise         = 0.06; // of the spacing: what a quadric misses on a noise-free surface
// What a robust quadric of n points fits away of the deviation is this over n (by simulation on planes).
constexpr Index  crowdSize        = 6;
constexpr double crowding         = 0.6; // of the distance that evenly spread points have
constexpr double fewestThinned    = 0.8;
constexpr Index  mostSearched     = 4;
constexpr double lostDeviation    = 9.5;
constexpr double surfaceNoises    = 7.0;  // radius of a voter in noise units, at least
constexpr double neighborGrowth   = 1.2;
constexpr double predictionVariance = 6.0; // of a voter of n points, times n over the variance
constexpr double minMajority      = 0.35;
constexpr double supportDistance2 = 4.5; // squared Mahalanobis distance; 4 is the rim of a uniform disk
constexpr double rimDistance2     = 9.0; // a corner of a quarter of a disk is at 7.4
constexpr double rimWeight        = 1e-2;
constexpr Index  company          = 4;
constexpr double companyDistance  = 3.0; // spacings
constexpr double bentOverAnEdge   = 1.5; // times the noise around
constexpr double bentWeight       = 1e-4;
constexpr double acceptance       = 0.05; // a point is good if this share of its votes says so
constexpr double coherence        = 1.5;  // noise units within which votes speak of one surface
constexpr int    meanShifts       = 4;
constexpr double isolatedShare    = 0.08; // of the usual number of votes
constexpr double hysteresisShare  = 1.8 / 3.5;
constexpr int    hysteresisPasses = 3;
constexpr double together         = 2.0; // sensitivities, for the mean of a group by its error
constexpr Index  hysteresisPeers  = 8;
constexpr Index  minFlaggedPeers  = 3;
constexpr double flaggedPeerShare = 0.4;

double median(std::vector<double>& values)
{
	const auto middle = values.begin() + values.size() / 2;
	std::nth_element(values.begin(), middle, values.end());
	return *middle;
}

struct Voter {
	Index              centre    = 0;
	Index              neighbors = 0; // asked for
	SurfacePatch       surface;
	double             spacing = 0.0;
	double             noise   = 0.0; // around it
	bool               bent    = false; // over an edge
	Vector2d           supportCentre;
	Matrix2d           supportShape; // inverse covariance of the points on the surface
	std::vector<Index> ball;         // all points within the radius of the centre, also rejected ones
};

double deviation(const Voter& voter)
{
	return voter.surface.scale / (1.0 - lostDeviation / voter.neighbors);
}

class RobustVote {
public:
	RobustVote(const Matrix3Xd& positions, double sensitivity);
	void          fitVoters(const Progress& progress);
	bool          vote(const Progress& progress); // true when something changed
	double        noise() const;
	OutlierResult result() const;

private:
	void  seatVoters();
	void  fit(Voter& voter, const std::vector<Index>& active, const NeighborSearch& search) const;
	void  measureNoise(const Progress& progress);
	void  collectVoters(); // of each point
	void  judge(Index i);
	bool  hasCompany(Index i, double spacing) const;
	void  followClusters(const Progress& progress);
	Index neighborsWanted(const Voter& voter) const;
	Index size() const { return static_cast<Index>(m_positions.cols()); }

	const Matrix3Xd&   m_positions;
	double             m_sensitivity;
	NeighborSearch     m_search;
	std::vector<Index> m_order; // independent of the order of the input
	std::vector<Index> m_rank;
	Index              m_neighbors, m_step, m_largest;
	std::vector<Voter> m_voters;
	std::vector<char>  m_stale; // voters to be fitted again
	NeighborLists      m_votersOf;

	std::vector<char>   m_rejected, m_flagged;
	std::vector<double> m_deviation; // noise units
	Matrix3Xd m_displacement;
	std::vector<double> m_crowd; // distance of the 6th neighbour
	std::vector<double> m_against, m_noise, m_spacing;
	std::vector<Index>  m_votes;
	Index               m_isolated = 0;
};

RobustVote::RobustVote(const Matrix3Xd& positions, double sensitivity) :
		m_positions(positions),
		m_sensitivity(sensitivity),
		m_search(positions),
		m_order(shuffledOrder(positions)),
		m_rank(positions.cols()),
		m_largest(std::max(fewestNeighbors, size() / smallestShare)),
		m_rejected(size(), 0),
		m_flagged(size(), 0),
		m_deviation(size(), 0.0),
		m_against(size(), 0.0),
		m_noise(size(), 0.0),
		m_spacing(size(), 0.0),
		m_votes(size(), 0)
{
	for (Index k = 0; k < size(); ++k)
		m_rank[m_order[k]] = k;
	m_displacement.setZero(3, size());
	m_crowd.resize(size());
	parallelFor(size(), {}, [&](Index i) {
		const auto near = m_search.nearest(m_positions.col(i), crowdSize + 1);
		m_crowd[i]      = (m_positions.col(near.back()) - m_positions.col(i)).norm();
	});
	m_neighbors = std::min(usualNeighbors, m_largest);
	m_step      = std::max<Index>(1, m_neighbors / votesPerPoint);
}

Index RobustVote::neighborsWanted(const Voter& voter) const
{
	if (!voter.surface.valid || voter.noise <= 0.0)
		return voter.neighbors;
	const double radius = surfaceNoises * voter.noise / voter.spacing;
	const double inside = EIGEN_PI * radius * radius;
	const auto   wanted = static_cast<Index>(
        std::min(inside, double(std::min(mostNeighbors, m_largest))));
	return wanted > neighborGrowth * voter.neighbors ? wanted : voter.neighbors;
}

// A random part of the cloud, and the points rejected before: those far from everything have no other
// voter that could take them back.
void RobustVote::seatVoters()
{
	std::vector<Index> seat(size(), -1);
	for (std::size_t v = 0; v < m_voters.size(); ++v)
		seat[m_voters[v].centre] = static_cast<Index>(v);
	std::vector<Voter> voters;
	std::vector<char>  stale;
	for (Index k = 0; k < size(); ++k) {
		const Index i = m_order[k];
		if (k % m_step != 0 && !m_rejected[i])
			continue;
		if (seat[i] >= 0) {
			Voter&      voter  = m_voters[seat[i]];
			const Index wanted = neighborsWanted(voter);
			stale.push_back(m_stale[seat[i]] || wanted != voter.neighbors);
			voter.neighbors = wanted;
			voters.push_back(std::move(voter));
		}
		else {
			stale.push_back(1);
			voters.emplace_back();
			voters.back().centre    = i;
			voters.back().neighbors = m_neighbors;
		}
	}
	m_voters = std::move(voters);
	m_stale  = std::move(stale);
}

void RobustVote::fit(
	Voter& voter, const std::vector<Index>& active, const NeighborSearch& search) const
{
	thread_local RobustPatchScratch scratch;
	thread_local Matrix3Xd          points;
	const Vector3d                  centre = m_positions.col(voter.centre);
	voter.ball.clear();
	thread_local std::vector<Index> even;
	double radius = 0.0;
	for (Index asked = voter.neighbors, attempt = 0; attempt < 2; ++attempt) {
		const std::vector<Index>        near   = search.nearest(centre, asked);
		if (near.empty()) return;
		radius = (m_positions.col(active[near.back()]) - centre).norm();
		const double usual = crowding * radius * std::sqrt(double(crowdSize) / near.size());
		even.clear();
		for (const Index n : near) {
			const Index i = active[n];
			const double share = m_crowd[i] / usual;
			if (share >= 1.0 || m_rank[i] < share * share * size())
				even.push_back(i);
		}
		if (even.size() >= fewestThinned * voter.neighbors || near.size() < std::size_t(asked))
			break;
		asked = std::min<Index>(mostSearched * asked, asked * voter.neighbors / std::max<Index>(even.size(), 1));
	}
	if (Index(even.size()) > voter.neighbors) {
		even.resize(voter.neighbors);
		radius = (m_positions.col(even.back()) - centre).norm();
	}
	points.resize(3, even.size());
	for (std::size_t k = 0; k < even.size(); ++k)
		points.col(k) = m_positions.col(even[k]);
	voter.spacing       = radius * std::sqrt(EIGEN_PI / std::max<double>(even.size(), 1.0));
	if (!fitPatchRobustly(
			voter.surface, points, radius, minNoise * voter.spacing, m_rank[voter.centre], scratch))
		return;
	Vector2d  mean       = Vector2d::Zero();
	Matrix2d  covariance = Matrix2d::Zero();
	int       on         = 0;
	const int n          = scratch.samples.size();
	for (int pass = 0; pass < 2; ++pass) {
		for (int k = 0; k < n; ++k) {
			if (std::abs(scratch.residuals[k]) >= 3.0 * voter.surface.scale)
				continue;
			const Vector2d p(scratch.samples.x[k], scratch.samples.y[k]);
			if (pass == 0) {
				mean += p;
				++on;
			}
			else {
				covariance += (p - mean) * (p - mean).transpose();
			}
		}
		if (pass == 0)
			mean /= std::max(on, 1);
	}
	voter.surface.valid = on > minMajority * n;
	if (!voter.surface.valid)
		return;
	voter.supportCentre = mean;
	voter.supportShape  = (covariance / on + 1e-12 * Matrix2d::Identity()).inverse();
	m_search.within(centre, radius, voter.ball);
}

void RobustVote::measureNoise(const Progress& progress)
{
	std::vector<Index> measuring;
	for (std::size_t v = 0; v < m_voters.size(); ++v)
		if (m_voters[v].surface.valid && !m_rejected[m_voters[v].centre])
			measuring.push_back(static_cast<Index>(v));
	Matrix3Xd origins(3, measuring.size());
	for (std::size_t k = 0; k < measuring.size(); ++k)
		origins.col(k) = m_voters[measuring[k]].surface.origin;
	const NeighborSearch search(origins);
	const Index          around = std::max<Index>(20, 2 * m_neighbors / m_step);
	parallelFor(static_cast<Index>(m_voters.size()), progress, [&](Index v) {
		Voter& voter = m_voters[v];
		if (!voter.surface.valid)
			return;
		thread_local std::vector<double> scales;
		scales.clear();
		for (const Index k : search.nearest(voter.surface.origin, around))
			scales.push_back(deviation(m_voters[measuring[k]]));
		voter.noise = scales.empty() ? deviation(voter) : median(scales);
		voter.bent  = deviation(voter) > bentOverAnEdge * voter.noise;
	});
}

void RobustVote::collectVoters()
{
	std::vector<Index>& offsets = m_votersOf.offsets;
	offsets.assign(size() + 1, 0);
	for (const Voter& voter : m_voters)
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

bool RobustVote::hasCompany(Index i, double spacing) const
{
	const auto near = m_search.nearest(m_positions.col(i), company + 1);
	return static_cast<Index>(near.size()) > company &&
		   (m_positions.col(near[company]) - m_positions.col(i)).norm() < companyDistance * spacing;
}

void RobustVote::judge(Index i)
{
	// Votes are displacements to the voter's surface: its normal has no meaningful sign.
	struct Vote {
		double   distance, weight;
		Vector3d toSurface;
		bool rim;
	};
	thread_local std::vector<Vote> votes;
	votes.clear();
	const Vector3d p     = m_positions.col(i);
	double         noise = 0.0, spacing = 0.0, nearness = 0.0, sum = 0.0, rimSum = 0.0;
	for (const Index v : m_votersOf[i]) {
		const Voter&              voter = m_voters[v];
		const SurfacePatch::Local local = voter.surface.toLocal(p);
		const Vector2d            offset(local.x - voter.supportCentre.x(), local.y - voter.supportCentre.y());
		const double              fromMiddle = offset.dot(voter.supportShape * offset);
		if (fromMiddle > rimDistance2)
			continue;
		const double r = voter.surface.residual(local);
		const double radius = voter.surface.radius;
		const double centred =
			1.0 - 0.9 * (p - m_positions.col(voter.centre)).squaredNorm() / (radius * radius);
		double weight = centred * centred;
		noise += weight * voter.noise * std::sqrt(1.0 + predictionVariance / voter.neighbors);
		spacing += weight * voter.spacing;
		nearness += weight;
		const bool rim = fromMiddle > supportDistance2;
		weight *= voter.bent ? bentWeight : rim ? rimWeight : 1.0;
		(rim ? rimSum : sum) += weight;
		votes.push_back({std::abs(r), weight, -r * voter.surface.normal(local.x, local.y), rim});
	}
	if (votes.empty())
		return;
	if (rimSum > sum && !hasCompany(i, spacing / nearness))
		rimSum = 0.0;
	if (rimSum <= sum)
		votes.erase(std::remove_if(votes.begin(), votes.end(), [](const Vote& v) { return v.rim; }), votes.end());
	else
		sum += rimSum;
	m_votes[i] = static_cast<Index>(votes.size());
	if (votes.empty())
		return;
	noise /= nearness;
	m_noise[i]   = noise;
	m_spacing[i] = spacing / nearness;
	std::sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) {
		return a.distance < b.distance;
	});
	Vector3d toSurface = votes.back().toSurface;
	double   passed = 0.0, for_ = 0.0;
	bool found=false;
	for (const Vote& vote : votes) {
		passed += vote.weight;
		if (!found && passed >= acceptance * sum) {
			toSurface = vote.toSurface;
			found=true;
		}
		if (vote.distance <= m_sensitivity * noise)
			for_ += vote.weight;
	}
	// The quantile alone is optimistic: go to the mean of the votes that agree with it.
	for (int step = 0; step < meanShifts; ++step) {
		Vector3d mean   = Vector3d::Zero();
		double   weight = 0.0;
		for (const Vote& vote : votes) {
			if ((vote.toSurface - toSurface).squaredNorm() > coherence * coherence * noise * noise)
				continue;
			mean += vote.weight * vote.toSurface;
			weight += vote.weight;
		}
		if (weight <= 0.0)
			break;
		toSurface = mean / weight;
	}
	m_displacement.col(i) = toSurface;
	m_deviation[i] = toSurface.norm() / noise;
	m_against[i]   = std::clamp(1.0 - for_ / sum, 0.0, 1.0);
}

// A doubtful point among rejected ones belongs to their cluster.
void RobustVote::followClusters(const Progress& progress)
{
	std::vector<Index> doubtful;
	for (Index i = 0; i < size(); ++i)
		if (!m_flagged[i] && m_deviation[i] > hysteresisShare * m_sensitivity)
			doubtful.push_back(i);
	std::vector<std::vector<Index>> peers(doubtful.size());
	parallelFor(static_cast<Index>(doubtful.size()), progress, [&](Index d) {
		const Index i = doubtful[d];
		for (const Index j : m_search.nearest(m_positions.col(i), hysteresisPeers + 1))
			if (j != i && (m_positions.col(j) - m_positions.col(i)).norm() < m_spacing[i])
				peers[d].push_back(j);
	});
	for (std::size_t d = 0; d < doubtful.size(); ++d) {
		const Index i   = doubtful[d];
		Vector3d    sum = m_displacement.col(i);
		for (const Index j : peers[d])
			sum += m_displacement.col(j);
		const double n = peers[d].size() + 1.0;
		if (sum.dot(m_displacement.col(i)) > together * m_sensitivity * m_noise[i] * std::sqrt(n) * m_displacement.col(i).norm())
			m_flagged[i] = 1;
	}
	for (int pass = 0; pass < hysteresisPasses; ++pass) {
		const std::vector<char> before = m_flagged;
		for (std::size_t d = 0; d < doubtful.size(); ++d) {
			const auto flagged = std::count_if(
				peers[d].begin(), peers[d].end(), [&](Index j) { return before[j]; });
			if (flagged >= minFlaggedPeers && flagged >= flaggedPeerShare * peers[d].size())
				m_flagged[doubtful[d]] = 1;
		}
	}
}

void RobustVote::fitVoters(const Progress& progress)
{
	std::vector<Index> active;
	for (const Index i : m_order)
		if (!m_rejected[i])
			active.push_back(i);
	seatVoters();
	Matrix3Xd activePositions(3, active.size());
	for (std::size_t k = 0; k < active.size(); ++k)
		activePositions.col(k) = m_positions.col(active[k]);
	const NeighborSearch search(activePositions);
	parallelFor(
		static_cast<Index>(m_voters.size()),
		progress.sub(0.0, 0.9, "Fitting surfaces"),
		[&](Index v) {
			if (m_stale[v])
				fit(m_voters[v], active, search);
		});
	measureNoise(progress.sub(0.9, 1.0, "Measuring the noise"));
}

bool RobustVote::vote(const Progress& progress)
{
	collectVoters();
	parallelFor(size(), progress.sub(0.0, 0.9, "Voting"), [&](Index i) { judge(i); });

	std::vector<double> counts(m_votes.begin(), m_votes.end());
	const double        fewest = counts.empty() ? 0.0 : isolatedShare * median(counts);
	m_isolated                 = 0;
	for (Index i = 0; i < size(); ++i) {
		const bool isolated = m_votes[i] == 0 || m_votes[i] < fewest;
		m_flagged[i]        = isolated || m_deviation[i] > m_sensitivity;
		m_isolated += isolated;
		if (isolated)
			m_against[i] = 1.0;
	}
	followClusters(progress.sub(0.9, 1.0, "Voting"));

	m_stale.assign(m_voters.size(), 0);
	bool changed = false;
	for (Index i = 0; i < size(); ++i) {
		if (m_flagged[i] == m_rejected[i])
			continue;
		changed = true;
		for (const Index v : m_votersOf[i])
			m_stale[v] = 1;
	}
	m_rejected = m_flagged;
	for (const Voter& voter : m_voters)
		changed |= neighborsWanted(voter) != voter.neighbors;
	return changed;
}

double RobustVote::noise() const
{
	std::vector<double> noise;
	for (const Voter& voter : m_voters)
		if (voter.surface.valid)
			noise.push_back(voter.noise);
	return noise.empty() ? 0.0 : median(noise);
}

OutlierResult RobustVote::result() const
{
	OutlierResult result;
	result.outlier  = m_rejected;
	result.score    = m_against;
	result.isolated = m_isolated;
	result.noise    = noise();
	return result;
}

} // namespace

OutlierResult rejectByRobustVotes(
	const Matrix3Xd& positions, double sensitivity, Index rounds, const Progress& progress)
{
	RobustVote    votes(positions, sensitivity);
	const Index   most = std::max<Index>(rounds, 1);
	Index         used = 0;
	for (bool changed = true; changed && used < most; ++used) {
		const Progress part =
			progress.sub(double(used) / most, double(used + 1) / most, "Rejecting outliers");
		votes.fitVoters(part.sub(0.0, 0.8, "Fitting surfaces"));
		changed = votes.vote(part.sub(0.8, 1.0, "Voting"));
	}
	OutlierResult result = votes.result();
	result.roundsUsed    = used;
	return result;
}

double surfaceNoise(const Matrix3Xd& positions, const Progress& progress)
{
	RobustVote votes(positions, 0.0);
	votes.fitVoters(progress);
	return votes.noise();
}

} // namespace curvature_lines
