// Samples of clouds: how many, from where, and the same whatever the order of the points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "even_sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

PointCloud noisyTorus(Index points)
{
	samples::SampleRequest request;
	request.surface   = "torus";
	request.points    = points;
	request.noise     = 0.0025;
	const auto sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

PointCloud chosen(const PointCloud& cloud, const std::vector<Index>& which)
{
	PointCloud part;
	part.positions.resize(3, which.size());
	part.normals.resize(3, which.size());
	for (std::size_t k = 0; k < which.size(); ++k) {
		part.positions.col(k) = cloud.positions.col(which[k]);
		part.normals.col(k)   = cloud.normals.col(which[k]);
	}
	return part;
}

TEST(EvenSample, HasAboutAsManyAsAskedInOrder)
{
	const PointCloud cloud = noisyTorus(20000);
	for (const Index most : {500, 5000, 19000}) {
		const std::vector<Index> sample = evenSample(cloud, most);
		EXPECT_NEAR(sample.size(), most, 4.0 * std::sqrt(double(most)));
		EXPECT_TRUE(std::is_sorted(sample.begin(), sample.end()));
		EXPECT_EQ(std::adjacent_find(sample.begin(), sample.end()), sample.end());
	}
	EXPECT_EQ(evenSample(cloud, 20000).size(), 20000u);
	EXPECT_TRUE(evenSample(PointCloud(), 10).empty());
}

TEST(EvenSample, ThinsDensePartsAndKeepsSparseOnes)
{
	const PointCloud   cloud = noisyTorus(40000);
	std::vector<Index> uneven; // a tenth of the points where x < 0
	for (Index i = 0; i < cloud.size(); ++i)
		if (cloud.positions(0, i) >= 0.0 || i % 10 == 0)
			uneven.push_back(i);
	const PointCloud scan   = chosen(cloud, uneven);
	Index            sparse = 0, keptSparse = 0, keptDense = 0;
	for (Index i = 0; i < scan.size(); ++i)
		sparse += scan.positions(0, i) < -0.05;
	for (const Index i : evenSample(scan, 6000)) {
		keptSparse += scan.positions(0, i) < -0.05;
		keptDense += scan.positions(0, i) > 0.05;
	}
	EXPECT_GT(keptSparse, 0.95 * sparse);
	EXPECT_GT(keptDense, 3000);
	EXPECT_LT(keptDense, 5000);
}

TEST(EvenSample, DoesNotDependOnTheOrderOfThePoints)
{
	const PointCloud   cloud = noisyTorus(5000);
	std::vector<Index> reversed(cloud.size());
	std::iota(reversed.rbegin(), reversed.rend(), 0);
	std::vector<Index> other = evenSample(chosen(cloud, reversed), 1000);
	for (Index& i : other)
		i = reversed[i];
	std::sort(other.begin(), other.end());
	EXPECT_EQ(evenSample(cloud, 1000), other);
}

// Points that noise moved out of the surface are no more frequent in the sample than in the cloud.
TEST(EvenSample, DoesNotFavourNoise)
{
	samples::SampleRequest request;
	request.surface      = "torus";
	request.points       = 40000;
	request.noise        = 0.0025;
	const auto noisy     = samples::generate(request);
	request.noise        = 0.0;
	const auto exact     = samples::generate(request);
	const auto deviation = [&](const std::vector<Index>& which) {
		double sum = 0.0;
		for (const Index i : which)
			sum += std::abs(
				(noisy.positions.col(i) - exact.positions.col(i)).dot(exact.normals.col(i)));
		return sum / double(which.size());
	};
	std::vector<Index> all(40000);
	std::iota(all.begin(), all.end(), 0);
	EXPECT_LT(deviation(all), 0.02);
	EXPECT_NEAR(
		deviation(evenSample(PointCloud{noisy.positions, noisy.normals}, 8000)) / deviation(all),
		1.0,
		0.05);
}

} // namespace
} // namespace curvature_lines
