// Pairs on random graphs, beside all shortest paths computed anew after every pair.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "closest_pairs.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

struct Case {
	MirrorGraph                     graph;
	std::vector<std::vector<Index>> nodes; // of every member
	std::vector<int>                counts;
};

// Groups of four nodes, of which 0 and 2, 1 and 3 are mirrors; some groups join all of theirs, as at singular points.
Case randomCase(int groups, int members, samples::Random& random)
{
	const Index                                 count = 4 * groups;
	std::vector<std::vector<MirrorGraph::Edge>> around(count);
	const auto                                  join = [&](Index a, Index b, double cost) {
        around[a].push_back({b, cost});
        around[b].push_back({a, cost});
	};
	const auto joinMirrored = [&](Index a, Index b, double cost) {
		join(a, b, cost);
		join(MirrorGraph::mirror(a), MirrorGraph::mirror(b), cost);
	};
	for (int g = 0; g < groups; ++g) {
		for (int k = 0; k < 2; ++k) {
			const auto other = static_cast<Index>(random.index(groups));
			if (other == g)
				continue;
			const auto quarter = static_cast<Index>(random.index(4));
			for (Index q = 0; q < 2; ++q)
				joinMirrored(4 * g + q, 4 * other + ((q + quarter) & 3), random.uniform(0.1, 1.0));
		}
		if (random.index(8) == 0)
			joinMirrored(4 * g, 4 * g + 1, 0.5);
	}
	Case result;
	for (Index n = 0; n < count; ++n) {
		result.graph.edges.insert(result.graph.edges.end(), around[n].begin(), around[n].end());
		result.graph.first.push_back(static_cast<Index>(result.graph.edges.size()));
	}
	for (int m = 0; m < members; ++m) {
		const auto node = static_cast<Index>(random.index(count));
		result.nodes.emplace_back(1, node);
		if (random.index(5) == 0)
			result.nodes.back().push_back(MirrorGraph::mirror(node));
		result.counts.push_back(1 + int(random.index(6) == 0));
	}
	return result;
}

std::vector<double> costsFrom(const MirrorGraph& graph, const std::vector<Index>& from)
{
	std::vector<double> cost(graph.nodeCount(), never);
	for (const Index node : from)
		cost[node] = 0.0;
	for (bool changed = true; changed;) {
		changed = false;
		for (Index n = 0; n < graph.nodeCount(); ++n)
			for (Index i = graph.first[n]; i < graph.first[n + 1]; ++i)
				if (cost[n] + graph.edges[i].cost < cost[graph.edges[i].to]) {
					cost[graph.edges[i].to] = cost[n] + graph.edges[i].cost;
					changed                 = true;
				}
	}
	return cost;
}

double leastCost(const Case& c)
{
	double least = never;
	for (std::size_t a = 0; a < c.nodes.size(); ++a) {
		const std::vector<double> cost = costsFrom(c.graph, c.nodes[a]);
		for (std::size_t b = 0; b < c.nodes.size(); ++b) {
			const bool isPair = c.counts[a] > 0 && (a == b ? c.counts[a] > 1 : c.counts[b] > 0);
			for (const Index node : c.nodes[b])
				if (isPair)
					least = std::min(least, cost[MirrorGraph::mirror(node)]);
		}
	}
	return least;
}

bool isAt(const std::vector<Index>& nodes, Index node)
{
	return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

// Infinite where it is none.
double costOf(const Case& c, const ClosestPairs::Pair& pair)
{
	if (!isAt(c.nodes[pair.first], pair.path.front()) ||
	    !isAt(c.nodes[pair.second], MirrorGraph::mirror(pair.path.back())))
		return never;
	double cost = 0.0;
	for (std::size_t k = 1; k < pair.path.size(); ++k) {
		double step = never;
		for (Index i = c.graph.first[pair.path[k - 1]]; i < c.graph.first[pair.path[k - 1] + 1];
		     ++i)
			if (c.graph.edges[i].to == pair.path[k])
				step = std::min(step, c.graph.edges[i].cost);
		cost += step;
	}
	return cost;
}

TEST(ClosestPairs, AreTheClosestOfAllEveryTime)
{
	samples::Random random(1, 0);
	int             pairsFound = 0;
	for (int k = 0; k < 60; ++k) {
		Case         c = randomCase(30, 3 + k % 12, random);
		ClosestPairs pairs(c.graph);
		for (std::size_t m = 0; m < c.nodes.size(); ++m)
			ASSERT_EQ(pairs.add(c.nodes[m], c.counts[m]), Index(m));
		for (;;) {
			ClosestPairs::Pair pair;
			const double       least = leastCost(c);
			ASSERT_EQ(pairs.closest(never, pair), least < never) << k;
			if (least == never)
				break;
			++pairsFound;
			ASSERT_NEAR(pair.cost, least, 1e-9) << k;
			ASSERT_NEAR(costOf(c, pair), least, 1e-9) << k;
			ASSERT_GE(pair.first, pair.second);
			for (const Index m : {pair.first, pair.second})
				pairs.setCount(m, --c.counts[m]);
		}
	}
	EXPECT_GT(pairsFound, 200);
}

TEST(ClosestPairs, NoneCostsMoreThanAllowed)
{
	samples::Random    random(2, 0);
	const Case         c     = randomCase(30, 4, random);
	const double       least = leastCost(c);
	ClosestPairs::Pair pair;
	ASSERT_LT(least, never);
	ClosestPairs pairs(c.graph);
	for (std::size_t m = 0; m < c.nodes.size(); ++m)
		pairs.add(c.nodes[m], c.counts[m]);
	EXPECT_FALSE(pairs.closest(least - 1e-6, pair));
	EXPECT_TRUE(pairs.closest(least + 1e-6, pair));
	// The same comes again.
	EXPECT_TRUE(pairs.closest(least + 1e-6, pair));
	EXPECT_NEAR(pair.cost, least, 1e-9);
}

TEST(ClosestPairs, NobodyHasNoPartner)
{
	MirrorGraph        graph;
	ClosestPairs::Pair pair;
	EXPECT_FALSE(ClosestPairs(graph).closest(never, pair));
	graph.first = {0, 0, 0, 0, 0};
	ClosestPairs alone(graph);
	alone.add({1}, 1);
	EXPECT_FALSE(alone.closest(never, pair));
	// A unit and what is missing in the same place
	ClosestPairs both(graph);
	both.add({1}, 1);
	both.add({3}, 1);
	ASSERT_TRUE(both.closest(never, pair));
	EXPECT_EQ(pair.cost, 0.0);
	EXPECT_EQ(pair.path, std::vector<Index>(1, 3));
}

} // namespace
} // namespace curvature_lines
