// Shortest paths in random graphs, against relaxing every edge until nothing changes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "shortest_paths.h"

#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"

namespace curvature_lines {
namespace {

struct Edge {
	Index  from, to;
	double length;
};

std::vector<double> relaxed(Index nodes, const std::vector<Edge>& edges, Index start)
{
	std::vector<double> cost(nodes, std::numeric_limits<double>::infinity());
	cost[start] = 0.0;
	for (bool changed = true; std::exchange(changed, false);)
		for (const Edge& edge : edges)
			if (cost[edge.from] + edge.length < cost[edge.to]) {
				cost[edge.to] = cost[edge.from] + edge.length;
				changed       = true;
			}
	return cost;
}

// One object for all searches, on graphs that grow.
TEST(ShortestPaths, AreShortestOnRandomGraphs)
{
	std::mt19937                           random(4);
	std::uniform_real_distribution<double> length(0.1, 1.0);
	ShortestPaths                          paths;
	for (Index nodes = 1; nodes <= 60; ++nodes) {
		std::vector<Edge> edges;
		for (Index k = 0; k < 3 * nodes; ++k)
			edges.push_back(
				{static_cast<Index>(random() % nodes),
			     static_cast<Index>(random() % nodes),
			     length(random)});
		const Index               start    = static_cast<Index>(random() % nodes);
		const std::vector<double> expected = relaxed(nodes, edges, start);
		std::vector<double>       found(nodes, std::numeric_limits<double>::infinity());
		double                    last = 0.0;
		paths.start(nodes);
		paths.reach(start, 0.0, -1);
		while (paths.isOpen()) {
			const auto [cost, node] = paths.nearest();
			EXPECT_GE(cost, last);
			last = cost;
			if (!paths.take())
				continue;
			EXPECT_GT(found[node], cost) << "taken once";
			found[node] = cost;
			for (const Edge& edge : edges)
				if (edge.from == node)
					paths.reach(edge.to, cost + edge.length, node);
		}
		EXPECT_EQ(found, expected);
		for (Index node = 0; node < nodes; ++node) {
			if (expected[node] == std::numeric_limits<double>::infinity())
				continue;
			EXPECT_EQ(paths.cost(node), expected[node]);
			Index first = node, steps = 0;
			for (; paths.before(first) >= 0 && steps <= nodes; ++steps) {
				EXPECT_LT(paths.cost(paths.before(first)), paths.cost(first));
				first = paths.before(first);
			}
			EXPECT_EQ(first, start);
		}
	}
}

TEST(ShortestPaths, OfEqualOnesTheLowerNodeFirst)
{
	ShortestPaths paths;
	paths.start(4);
	for (const Index node : {3, 1, 2})
		paths.reach(node, 1.0, -1);
	paths.reach(1, 1.0, 0); // not shorter: as it was
	for (const Index node : {1, 2, 3}) {
		EXPECT_EQ(paths.nearest().second, node);
		EXPECT_TRUE(paths.take());
		EXPECT_EQ(paths.before(node), -1);
	}
	EXPECT_FALSE(paths.isOpen());
}

} // namespace
} // namespace curvature_lines
