// The box tree against brute force on random clouds of every fill of its boxes, and its spatial order.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "core/box_tree.h"

namespace curvature_lines {
namespace {

Eigen::Matrix3Xd randomPoints(int count, int seed)
{
	samples::Random  random(seed, 0);
	Eigen::Matrix3Xd positions(3, count);
	for (int i = 0; i < count; ++i)
		positions.col(i) = random.normal3();
	if (count > 20) // some of them at one place
		for (int i = 0; i < count; i += 5)
			positions.col(i) = positions.col(1);
	return positions;
}

std::vector<BoxTree::Found> bruteForce(const Eigen::Matrix3Xd& positions, const Eigen::Vector3d& query)
{
	std::vector<BoxTree::Found> all;
	for (Index i = 0; i < positions.cols(); ++i) {
		const Eigen::Vector3d d = positions.col(i) - query;
		all.emplace_back(d.x() * d.x() + d.y() * d.y() + d.z() * d.z(), i);
	}
	std::sort(all.begin(), all.end());
	return all;
}

TEST(BoxTree, AgreesWithBruteForce)
{
	samples::Random random(7, 1);
	for (const int count : {1, 2, 7, 8, 9, 63, 64, 65, 511, 513, 4100}) {
		const Eigen::Matrix3Xd      positions = randomPoints(count, count);
		const BoxTree               tree(positions);
		std::vector<BoxTree::Found> nearest;
		std::vector<Index>          within;
		for (int q = 0; q < 20; ++q) {
			const Eigen::Vector3d query = q % 2 == 0 ? Eigen::Vector3d(positions.col(q % count)) :
													   Eigen::Vector3d(2.0 * random.normal3());
			const auto            all   = bruteForce(positions, query);
			for (const int k : {1, 3, 40, 600}) {
				tree.nearest(query, k, nearest);
				ASSERT_EQ(nearest.size(), std::min<std::size_t>(k, all.size()));
				EXPECT_TRUE(std::equal(nearest.begin(), nearest.end(), all.begin())) << count << " " << k;
			}
			for (const double radius : {0.0, 0.3, 1.0, 9.0}) {
				std::vector<Index> expected;
				for (const auto& [squared, i] : all)
					if (squared <= radius * radius)
						expected.push_back(i);
				tree.within(query, radius, within);
				EXPECT_EQ(tree.anyWithin(query, radius), !expected.empty());
				std::sort(expected.begin(), expected.end());
				std::sort(within.begin(), within.end());
				EXPECT_EQ(within, expected) << count << " " << radius;
			}
		}
	}
}

TEST(BoxTree, SpatialOrderTakesShortSteps)
{
	const Eigen::Matrix3Xd positions = randomPoints(4000, 3);
	const BoxTree          tree(positions);
	std::vector<Index>     order = tree.spatialOrder();
	const auto             length = [&](const std::vector<Index>& way) {
        double sum = 0.0;
        for (std::size_t k = 1; k < way.size(); ++k)
            sum += (positions.col(way[k]) - positions.col(way[k - 1])).norm();
        return sum;
	};
	std::vector<Index> given(positions.cols());
	std::iota(given.begin(), given.end(), 0);
	EXPECT_LT(length(order), 0.2 * length(given));
	std::sort(order.begin(), order.end());
	EXPECT_EQ(order, given);
}

} // namespace
} // namespace curvature_lines
