// Shortest paths from one node of a graph (Dijkstra 1959), for searches that start again and again and mostly end early.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// Nodes are numbers below nodeCount; the caller knows the edges. A search: start(), reach() for every node it begins at,
// then as long as it isOpen(): look at nearest(), take() it, and reach() its neighbours.
class ShortestPaths {
public:
	using Open = std::pair<double, Index>; // cost, node: among equal costs the lower node is first

	// Forgets the last search in no time.
	void start(Index nodeCount)
	{
		m_reached.resize(nodeCount);
		m_open = {};
		++m_search;
	}

	// There is a path to `node` of that cost, by way of the node before; -1: it begins here.
	void reach(Index node, double cost, Index before)
	{
		Reached& reached = m_reached[node];
		if (reached.search == m_search && reached.cost <= cost)
			return;
		reached = {cost, before, m_search};
		m_open.emplace(cost, node);
	}

	bool isOpen() const { return !m_open.empty(); }
	Open nearest() const { return m_open.top(); }
	// False: a shorter path to the node was taken before.
	bool take()
	{
		const auto [cost, node] = m_open.top();
		m_open.pop();
		return cost == m_reached[node].cost;
	}

	// Of nodes reached in this search.
	double cost(Index node) const { return m_reached[node].cost; }
	Index before(Index node) const { return m_reached[node].before; }

private:
	struct Reached {
		double cost   = 0.0;
		Index  before = -1;
		int    search = 0;
	};
	std::vector<Reached>                                         m_reached;
	std::priority_queue<Open, std::vector<Open>, std::greater<>> m_open;
	int                                                          m_search = 0;
};

} // namespace curvature_lines
