// Sets that are joined, against relabelling every element.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "disjoint_sets.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

TEST(DisjointSets, AreNamedByTheirSmallestMember)
{
	std::mt19937 random(9);
	for (int trial = 0; trial < 50; ++trial) {
		const Index        n = 1 + static_cast<Index>(random() % 80);
		DisjointSets       sets(n);
		std::vector<Index> label(n);
		std::iota(label.begin(), label.end(), 0);
		for (Index step = 0; step < n; ++step) {
			const Index i = static_cast<Index>(random() % n), j = static_cast<Index>(random() % n);
			const Index a = label[i], b = label[j];
			EXPECT_EQ(sets.join(i, j), a != b);
			for (Index& l : label)
				if (l == std::max(a, b))
					l = std::min(a, b);
			for (Index k = 0; k < n; ++k)
				ASSERT_EQ(sets.find(k), label[k]);
		}
	}
}

TEST(DisjointSets, OneLongChain)
{
	const Index  n = 200000;
	DisjointSets sets(n);
	for (Index i = n - 1; i > 0; --i)
		EXPECT_TRUE(sets.join(i, i - 1));
	for (const Index i : {0, 1, n / 2, n - 1})
		EXPECT_EQ(sets.find(i), 0);
	EXPECT_FALSE(sets.join(0, n - 1));
}

} // namespace
} // namespace curvature_lines
