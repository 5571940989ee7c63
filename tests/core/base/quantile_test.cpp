// Order statistics against sorting.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "quantile.h"

namespace curvature_lines {
namespace {

TEST(Quantile, IsTheValueThatSortingPutsThere)
{
	std::mt19937 random(5);
	for (int trial = 0; trial < 300; ++trial) {
		std::vector<double> values(1 + random() % 60);
		for (double& v : values)
			v = double(random() % 20) - 10.0; // with ties
		std::vector<double> sorted = values;
		std::sort(sorted.begin(), sorted.end());
		for (const double share : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
			const std::size_t at = std::min<std::size_t>(
				std::size_t(share * double(sorted.size())), sorted.size() - 1);
			EXPECT_EQ(quantile(values, share), sorted[at]);
		}
		std::vector<double> inPlace = values;
		EXPECT_EQ(medianInPlace(inPlace), sorted[sorted.size() / 2]);
		std::sort(inPlace.begin(), inPlace.end());
		EXPECT_EQ(inPlace, sorted); // reordered, and nothing else
	}
}

TEST(Quantile, OfOneValueIsThatValue)
{
	for (const double share : {0.0, 0.5, 1.0})
		EXPECT_EQ(quantile({7.0}, share), 7.0);
}

} // namespace
} // namespace curvature_lines
