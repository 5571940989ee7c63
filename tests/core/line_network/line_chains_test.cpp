// Edges joined to lines: order, direction, closed lines, and what is none.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_chains.h"

#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Lines = std::vector<std::vector<Index>>;

TEST(LineChains, OpenLinesStartAtTheirLowerEnd)
{
	const auto chains = chainEdges(6, {{3, 1}, {5, 3}, {4, 2}}); // 0 has no edge
	ASSERT_TRUE(chains);
	EXPECT_EQ(chains->vertices, (Lines{{1, 3, 5}, {2, 4}}));
	EXPECT_EQ(chains->closed, (std::vector<char>{0, 0}));
}

TEST(LineChains, ClosedLinesStartAtTheirLowestVertexTowardsItsLowerNeighbour)
{
	const auto chains = chainEdges(4, {{2, 3}, {0, 3}, {1, 2}, {1, 0}});
	ASSERT_TRUE(chains);
	EXPECT_EQ(chains->vertices, (Lines{{0, 1, 2, 3}}));
	EXPECT_EQ(chains->closed, (std::vector<char>{1}));
}

TEST(LineChains, ComeInTheOrderOfTheirFirstVertices)
{
	// a closed line on 0 1 2, an open one on 3 4, a closed one on 5 6 7
	const auto chains = chainEdges(8, {{7, 5}, {5, 6}, {6, 7}, {4, 3}, {0, 1}, {1, 2}, {2, 0}});
	ASSERT_TRUE(chains);
	EXPECT_EQ(chains->vertices, (Lines{{0, 1, 2}, {3, 4}, {5, 6, 7}}));
	EXPECT_EQ(chains->closed, (std::vector<char>{1, 0, 1}));
	EXPECT_EQ(chains->size(), 3);
}

TEST(LineChains, LinesThatBranchAreNone)
{
	EXPECT_FALSE(chainEdges(4, {{0, 1}, {0, 2}, {0, 3}}));
}

TEST(LineChains, NoEdgesNoLines)
{
	const auto chains = chainEdges(3, {});
	ASSERT_TRUE(chains);
	EXPECT_EQ(chains->size(), 0);
}

} // namespace
} // namespace curvature_lines
