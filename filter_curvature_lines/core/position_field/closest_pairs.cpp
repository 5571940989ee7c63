// The two nearest members of every node (Dijkstra 1959, from all members at once), mended where a member goes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "closest_pairs.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

ClosestPairs::ClosestPairs(const MirrorGraph& graph) : m_graph(graph), m_labels(graph.nodeCount())
{
}

Index ClosestPairs::add(const std::vector<Index>& nodes, int count)
{
	const auto member = static_cast<Index>(m_count.size());
	m_count.push_back(count);
	m_nodes.push_back(nodes);
	for (const Index node : nodes) {
		m_membersAt.emplace(node, member);
		m_open.emplace(0.0, node, member, -1);
	}
	return member;
}

bool ClosestPairs::accepts(Index node, Index member) const
{
	const Labels& labels = m_labels[node];
	return labels[1].member < 0 && labels[0].member != member;
}

ClosestPairs::Label ClosestPairs::labelOf(Index node, Index member) const
{
	const Labels& labels = m_labels[node];
	return labels[labels[0].member == member ? 0 : 1];
}

// The path from the label's member over `node` and `next`, on to each of those that reach the mirror of that.
void ClosestPairs::meet(Index node, const Label& label, Index next, double cost)
{
	const Index mirror = MirrorGraph::mirror(next);
	for (const Label& other : m_labels[mirror]) {
		if (other.member < 0 || !isPair(label.member, other.member))
			continue;
		const double whole = label.cost + cost + other.cost;
		if (label.member >= other.member)
			m_meetings.emplace(whole, label.member, node, other.member, mirror);
		else
			m_meetings.emplace(whole, other.member, mirror, label.member, node);
	}
}

void ClosestPairs::take(const Reach& reach)
{
	const auto& [cost, node, member, before] = reach;
	if (m_count[member] == 0 || !accepts(node, member))
		return;
	Labels&     labels = m_labels[node];
	const Label label  = {member, cost, before};

	labels[labels[0].member < 0 ? 0 : 1] = label;
	if (before < 0)
		meet(node, label, node, 0.0);
	for (Index i = m_graph.first[node]; i < m_graph.first[node + 1]; ++i) {
		const MirrorGraph::Edge& edge = m_graph.edges[i];
		meet(node, label, edge.to, edge.cost);
		if (accepts(edge.to, member))
			m_open.emplace(cost + edge.cost, edge.to, member, node);
	}
}

bool ClosestPairs::closest(double mostCost, Pair& pair)
{
	for (;;) {
		// On the path of a pair not met yet there is an edge with the middle on it, and to one of its ends nobody has come:
		// the path is at least twice as long as what has been reached.
		const double reached =
			m_open.empty() ? std::numeric_limits<double>::infinity() : std::get<0>(m_open.top());
		if (!m_meetings.empty() && std::get<0>(m_meetings.top()) <= 2.0 * reached) {
			const auto [cost, first, node, second, mirror] = m_meetings.top();
			if (cost > mostCost)
				return false;
			if (!isPair(first, second)) {
				m_meetings.pop();
				continue;
			}
			pair = {cost, first, second, {}};
			for (Index at = node; at >= 0; at = labelOf(at, first).before)
				pair.path.push_back(at);
			std::reverse(pair.path.begin(), pair.path.end());
			for (Index at = mirror; at >= 0; at = labelOf(at, second).before)
				if (MirrorGraph::mirror(at) != pair.path.back())
					pair.path.push_back(MirrorGraph::mirror(at));
			return true;
		}
		if (!(2.0 * reached <= mostCost) || m_open.empty())
			return false;
		const Reach reach = m_open.top();
		m_open.pop();
		take(reach);
	}
}

void ClosestPairs::setCount(Index member, int count)
{
	m_count[member] = count;
	if (count == 0)
		remove(member);
}

// The other label of a node stays as it is; the free one goes to whom the nodes around say.
void ClosestPairs::remove(Index member)
{
	std::vector<Index> open, changed;
	const auto         drop = [&](Index node, Index before) {
        Labels& labels = m_labels[node];
        for (int i = 0; i < 2; ++i)
            if (labels[i].member == member && labels[i].before == before) {
                if (i == 0)
                    labels[0] = labels[1];
                labels[1] = {};
                open.push_back(node);
                return;
            }
	};
	for (const Index node : m_nodes[member])
		drop(node, -1);
	while (!open.empty()) {
		const Index node = open.back();
		open.pop_back();
		changed.push_back(node);
		for (Index i = m_graph.first[node]; i < m_graph.first[node + 1]; ++i)
			drop(m_graph.edges[i].to, node);
	}
	for (const Index node : changed) {
		const auto [begin, end] = m_membersAt.equal_range(node);
		for (auto at = begin; at != end; ++at)
			m_open.emplace(0.0, node, at->second, -1);
		for (Index i = m_graph.first[node]; i < m_graph.first[node + 1]; ++i) {
			const MirrorGraph::Edge& edge = m_graph.edges[i];
			for (const Label& label : m_labels[edge.to])
				if (label.member >= 0 && accepts(node, label.member))
					m_open.emplace(label.cost + edge.cost, node, label.member, edge.to);
		}
	}
}

} // namespace curvature_lines
