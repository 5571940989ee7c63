// Matching of curve points on the sides of a triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_curves.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace curvature_lines {
namespace {

// Counter-clockwise place of a side point on the border.
int rank(const std::array<int, 3>& counts, const SidePoint& p)
{
	int rank = p.index;
	for (int c = 0; c < p.side; ++c)
		rank += counts[c];
	return rank;
}

TEST(MatchSides, AllCountsGiveDisjointChordsBetweenDifferentSides)
{
	for (int code = 0; code < 5 * 5 * 5; ++code) {
		const std::array<int, 3>         counts = {code % 5, code / 5 % 5, code / 25};
		const auto                       arcs   = matchSides(counts);
		std::set<int>                    used;
		std::vector<std::pair<int, int>> chords;
		for (const auto& [p, q] : arcs) {
			EXPECT_NE(p.side, q.side);
			for (const SidePoint& point : {p, q}) {
				EXPECT_GE(point.index, 0);
				EXPECT_LT(point.index, counts[point.side]);
				EXPECT_TRUE(used.insert(rank(counts, point)).second) << code;
			}
			chords.push_back(std::minmax(rank(counts, p), rank(counts, q)));
		}
		for (const auto& [a, b] : chords)
			for (const auto& [c, d] : chords)
				EXPECT_FALSE(a < c && c < b && b < d) << code;
		// What is left lies on one side, and is as little as parity and the longest side allow.
		const int sum   = counts[0] + counts[1] + counts[2];
		const int most  = *std::max_element(counts.begin(), counts.end());
		const int least = std::max(sum % 2, 2 * most - sum);
		EXPECT_EQ(sum - 2 * static_cast<int>(arcs.size()), least) << code;
	}
}

} // namespace
} // namespace curvature_lines
