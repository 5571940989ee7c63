// Probes of connected parts of a cloud: what lies beside a part is no evidence for its scale.
// Internal to adaptive_scale.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

// Stays where it is: the tree refers to the positions.
class ProbeComponent {
public:
	ProbeComponent(const Eigen::Matrix3Xd& positions, std::vector<Index> probes);
	ProbeComponent(const ProbeComponent&) = delete;

	Index size() const { return static_cast<Index>(m_probes.size()); }
	const std::vector<Index>& probes() const { return m_probes; }
	// Probes by increasing distance, at most `count`.
	std::vector<Index> nearest(const Eigen::Vector3d& position, Index count) const;

private:
	std::vector<Index> m_probes;
	Eigen::Matrix3Xd   m_positions;
	NeighborSearch     m_search;
};

// `probes` hang together where two are among the nearest of each other.
std::deque<ProbeComponent>
connectedComponents(const Eigen::Matrix3Xd& positions, const std::vector<Index>& probes);

} // namespace curvature_lines
