// Groups of rejected points, and surfaces continued into them pass by pass.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_groups.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "outlier_ballot.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

constexpr char stage[] = "Restoring groups";

// By experiment: clean bunny and cow, a sheet with grooves, and clusters beside a torus, which must stay rejected
// (benchmarks/cleaning.py). Groups of 2 and of 20 lost clusters.
constexpr Index smallVoter = 30; // points of the patches that judge groups
// Smaller groups would have the majority of such a patch.
constexpr Index  fewestInGroup = smallVoter;
constexpr double linkLength    = 2.0; // spacings: rejected points so near are of one group
// Deviation over heightDeviation up to which a patch is one surface.
constexpr double oneSurface = 1.5;
// Of the points on the patch, those that join the group to the rest.
constexpr double acceptedShare = 0.25;
constexpr int    mostPasses    = 30; // each takes back points within a patch of the last

class GroupRestoration {
public:
	GroupRestoration(
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
	void findGroups();
	bool belongs(const VoterCloud& candidates, Index i) const;

	const VoterCloud&           m_cloud;
	const std::vector<Verdict>& m_verdicts;
	double                      m_heightDeviation, m_sensitivity;
	std::vector<char>&          m_rejected;
	std::vector<Index>          m_grouped; // rejected points of large groups
};

void GroupRestoration::findGroups()
{
	const Index        n = static_cast<Index>(m_rejected.size());
	std::vector<char>  seen(n, 0);
	std::vector<Index> group, near;
	for (Index first = 0; first < n; ++first) {
		if (!m_rejected[first] || seen[first])
			continue;
		group.assign(1, first);
		seen[first] = 1;
		for (std::size_t k = 0; k < group.size(); ++k) {
			const Index  i       = group[k];
			const double spacing = spacingOfCrowd * m_cloud.crowding[i];
			const double usual   = m_verdicts[i].spacing;
			m_cloud.all.within(
				m_cloud.positions.col(i),
				linkLength * (usual > 0.0 ? std::min(usual, spacing) : spacing),
				near);
			for (const Index j : near)
				if (m_rejected[j] && !seen[j]) {
					seen[j] = 1;
					group.push_back(j);
				}
		}
		if (static_cast<Index>(group.size()) >= fewestInGroup)
			m_grouped.insert(m_grouped.end(), group.begin(), group.end());
	}
	std::sort(m_grouped.begin(), m_grouped.end());
}

bool GroupRestoration::belongs(const VoterCloud& candidates, Index i) const
{
	thread_local OutlierVoter voter;
	voter           = OutlierVoter();
	voter.centre    = i;
	voter.neighbors = smallVoter;
	fitVoter(voter, candidates);
	if (!voter.surface.valid)
		return false;
	voter.heightDeviation =
		m_verdicts[i].heightError > 0.0 ? m_verdicts[i].heightError : m_heightDeviation;
	if (voter.deviation() > oneSurface * voter.heightDeviation)
		return false;
	const double reach    = m_sensitivity * voter.heightError();
	const auto   residual = [&](Index j) {
        return std::abs(voter.surface.residual(voter.surface.toLocal(m_cloud.positions.col(j))));
	};
	if (residual(i) > reach)
		return false;
	Index on = 0, accepted = 0;
	for (const Index j : voter.ball)
		if (residual(j) <= reach) {
			++on;
			accepted += !m_rejected[j];
		}
	return accepted >= acceptedShare * on;
}

void GroupRestoration::run(const Progress& progress)
{
	findGroups();
	if (m_grouped.empty())
		return;
	// Patches are fitted to the accepted points and all groups, in every pass the same.
	std::vector<char> candidate(m_rejected.size());
	for (std::size_t i = 0; i < candidate.size(); ++i)
		candidate[i] = !m_rejected[i];
	for (const Index i : m_grouped)
		candidate[i] = 1;
	std::vector<Index> active;
	for (std::size_t i = 0; i < candidate.size(); ++i)
		if (candidate[i])
			active.push_back(static_cast<Index>(i));
	const Eigen::Matrix3Xd positions = columnsOf(m_cloud.positions, active);
	const NeighborSearch   search(positions);
	const VoterCloud       cloud{
        m_cloud.positions, m_cloud.crowding, m_cloud.rank, m_cloud.all, active, search};
	double done = 0.0;
	for (int pass = 0; pass < mostPasses; ++pass) {
		std::vector<char> restored(m_grouped.size(), 0);
		// how many passes there are is not known: each gets half of what is left
		const double then = 0.5 * (done + 1.0);
		parallelFor(
			static_cast<Index>(m_grouped.size()), progress.sub(done, then, stage), [&](Index k) {
				restored[k] = belongs(cloud, m_grouped[k]);
			});
		done = then;
		std::vector<Index> left;
		for (std::size_t k = 0; k < m_grouped.size(); ++k)
			if (restored[k])
				m_rejected[m_grouped[k]] = 0;
			else
				left.push_back(m_grouped[k]);
		if (left.size() == m_grouped.size())
			return;
		m_grouped = std::move(left);
	}
}

} // namespace

void restoreGroups(
	const VoterCloud&           cloud,
	const std::vector<Verdict>& verdicts,
	double                      heightDeviation,
	double                      sensitivity,
	std::vector<char>&          rejected,
	const Progress&             progress)
{
	GroupRestoration(cloud, verdicts, heightDeviation, sensitivity, rejected).run(progress);
}

} // namespace curvature_lines
