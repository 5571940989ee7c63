// Components of the graph of mutual nearest probes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "probe_components.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

constexpr Index linkedProbes = 12;

} // namespace

ProbeComponent::ProbeComponent(const Eigen::Matrix3Xd& positions, std::vector<Index> probes) :
		m_probes(std::move(probes)), m_positions(columnsOf(positions, m_probes)),
		m_search(m_positions)
{
}

std::vector<Index> ProbeComponent::nearest(const Eigen::Vector3d& position, Index count) const
{
	std::vector<Index> near = m_search.nearest(position, count);
	for (Index& k : near)
		k = m_probes[k];
	return near;
}

std::deque<ProbeComponent>
connectedComponents(const Eigen::Matrix3Xd& positions, const std::vector<Index>& probes)
{
	const ProbeComponent            all(positions, probes);
	std::vector<std::vector<Index>> near(positions.cols());
	for (const Index p : probes)
		near[p] = all.nearest(positions.col(p), linkedProbes);
	const auto linked = [&](Index p, Index q) {
		return std::find(near[q].begin(), near[q].end(), p) != near[q].end();
	};
	std::deque<ProbeComponent> components;
	std::vector<char>          reached(positions.cols(), 0);
	for (const Index first : probes) {
		if (reached[first])
			continue;
		std::vector<Index> members{first};
		reached[first] = 1;
		for (std::size_t k = 0; k < members.size(); ++k) {
			const Index p = members[k];
			for (const Index q : near[p])
				if (!reached[q] && linked(p, q)) {
					reached[q] = 1;
					members.push_back(q);
				}
		}
		components.emplace_back(positions, std::move(members));
	}
	return components;
}

} // namespace curvature_lines
