// Selection near a guess against a sorted list: the guess must never change the result.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "bracketed_selection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

using namespace curvature_lines;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Negative values are those to be left out.
void expectSameAsSorted(const std::vector<double>& values)
{
	std::vector<double> sorted, scratch;
	for (const double value : values)
		if (value >= 0.0)
			sorted.push_back(value);
	std::sort(sorted.begin(), sorted.end());
	const auto   valueAt = [&](int k) { return values[k]; };
	const int    n       = static_cast<int>(values.size());
	const double middle  = sorted.empty() ? 1.0 : sorted[sorted.size() / 2];
	for (const double guess :
	     {middle,
	      1.3 * middle,
	      0.2 * middle,
	      7.0 * middle,
	      1e9 * middle,
	      0.0,
	      -1.0,
	      1e-320,
	      infinity,
	      std::nan("")})
		for (const double share : {0.0, 0.35, 0.5, 0.999}) {
			std::size_t    asked = 0;
			const Selected found = selectNear(
				guess,
				n,
				valueAt,
				[&](std::size_t count) {
					return asked = static_cast<std::size_t>(share * double(count));
				},
				scratch);
			if (sorted.empty()) {
				EXPECT_LT(found.value, 0.0);
				continue;
			}
			EXPECT_EQ(found.value, sorted[asked])
				<< n << " values, guess " << guess << ", share " << share;
			EXPECT_EQ(found.next, sorted[std::min(asked + 1, sorted.size() - 1)])
				<< n << " values, guess " << guess;
			EXPECT_EQ(quantileNear(guess, n, valueAt, share, scratch), sorted[asked]);
		}
}

std::vector<double> squaredNormal(int n, unsigned seed)
{
	std::mt19937                     random(seed);
	std::normal_distribution<double> normal;
	std::vector<double>              values(n);
	for (double& value : values)
		value = std::pow(normal(random), 2);
	return values;
}

} // namespace

TEST(BracketedSelection, AgreesWithASortedList)
{
	for (const int n : {1, 2, 3, 31, 32, 33, 200, 2001})
		for (unsigned seed = 1; seed <= 5; ++seed)
			expectSameAsSorted(squaredNormal(n, seed));
}

TEST(BracketedSelection, LeavesOutNegativeValues)
{
	std::vector<double> values = squaredNormal(500, 1);
	for (std::size_t k = 0; k < values.size(); k += 3)
		values[k] = -1.0;
	expectSameAsSorted(values);
	expectSameAsSorted({});
	expectSameAsSorted({-1.0, -2.0});
}

TEST(BracketedSelection, TiesZerosAndInfinities)
{
	expectSameAsSorted(std::vector<double>(100, 0.0));
	expectSameAsSorted(std::vector<double>(100, 2.5));
	std::vector<double> values = squaredNormal(300, 2);
	for (std::size_t k = 0; k < values.size(); ++k)
		values[k] = k % 5 == 0 ? infinity : k % 5 == 1 ? 0.0 : std::round(4.0 * values[k]);
	expectSameAsSorted(values);
	expectSameAsSorted(std::vector<double>(50, infinity));
}

TEST(BracketedSelection, ScalesFarApart)
{
	std::vector<double> values = squaredNormal(200, 3);
	for (std::size_t k = 0; k < values.size(); ++k)
		values[k] *= k % 2 == 0 ? 1e-200 : 1e200;
	expectSameAsSorted(values);
}
