// Pairs in a graph that are joined closest first, although who is closest to whom changes with every pair that goes: all
// search at once, and each search ends where others are closer.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <map>
#include <queue>
#include <tuple>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// Undirected. Every node has a mirror node; between mirrors of two nodes there is an edge as between them.
struct MirrorGraph {
	struct Edge {
		Index  to   = -1;
		double cost = 0.0;
	};
	std::vector<Index> first = {0}; // of every node its first edge, and the end
	std::vector<Edge>  edges;

	Index nodeCount() const { return static_cast<Index>(first.size()) - 1; }
	static Index mirror(Index node) { return node ^ 2; }
};

// Members are at nodes, some at several. A path leads from a member to the mirror of another one's node.
class ClosestPairs {
public:
	struct Pair {
		double             cost  = 0.0;
		Index              first = -1, second = -1; // members, first >= second
		std::vector<Index> path; // from a node of the first to the mirror of one of the second
	};

	explicit ClosestPairs(const MirrorGraph& graph);

	// Before the first pair. Returns the member's number. One that counts more than once may be its own partner.
	Index add(const std::vector<Index>& nodes, int count);
	// The closest pair, if it costs no more than that. The same comes again until the counts change.
	bool closest(double mostCost, Pair& pair);
	// Counts only fall; with 0 the member is gone.
	void setCount(Index member, int count);

private:
	// Of the two members closest to a node: with one only, a member near its own mirror would hide all others.
	struct Label {
		Index  member = -1;
		double cost   = 0.0;
		Index  before = -1; // node on the path from the member, -1: the member is here
	};
	using Labels = std::array<Label, 2>;
	using Reach  = std::tuple<double, Index, Index, Index>; // cost, node, member, node before
	// Cost, first member, a node on the path from it, second, the mirror of the next node of the path
	using Meeting = std::tuple<double, Index, Index, Index, Index>;
	template<class Item>
	using Queue = std::priority_queue<Item, std::vector<Item>, std::greater<>>;

	bool isPair(Index first, Index second) const
	{
		return m_count[first] > 0 && (first == second ? m_count[first] > 1 : m_count[second] > 0);
	}
	bool accepts(Index node, Index member) const;
	Label labelOf(Index node, Index member) const;
	void take(const Reach& reach);
	void meet(Index node, const Label& label, Index next, double cost);
	void remove(Index member);

	const MirrorGraph&              m_graph;
	std::vector<int>                m_count;     // of every member
	std::vector<std::vector<Index>> m_nodes;     // of every member
	std::multimap<Index, Index>     m_membersAt; // of nodes
	std::vector<Labels>             m_labels;
	Queue<Reach>                    m_open;
	Queue<Meeting>                  m_meetings;
};

} // namespace curvature_lines
