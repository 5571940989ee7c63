// Where a random sample ends: exact and noisy, straight, bent and beside the window's end, with strays; nothing
// where there is nothing to tell.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "frontier.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix2Xd;
using samples::Random;

constexpr double reach = 30.0; // of the samples, in spacings

// One point per unit area up to `bend` s², to 12 units inside: deeper than the frontier bends.
Matrix2Xd sample(int seed, double bend, double noise)
{
	const double                 deepest = -12.0;
	Random                       random(seed, 0);
	std::vector<Eigen::Vector2d> points;
	const int count = static_cast<int>(2.0 * reach * (std::abs(bend) * reach * reach - deepest));
	for (int k = 0; k < count; ++k) {
		const double s = random.uniform(-reach, reach),
					 x = random.uniform(deepest, std::abs(bend) * reach * reach);
		if (x < bend * s * s)
			points.emplace_back(s, x + noise * random.normal());
	}
	return Eigen::Map<Matrix2Xd>(points[0].data(), 2, points.size());
}

struct Errors {
	double mean = 0.0, rms = 0.0, claimed = 0.0;
};

Errors errors(double bend, double noise, double begin = -reach, double end = reach)
{
	constexpr int seeds = 60;
	Errors        found;
	for (int seed = 0; seed < seeds; ++seed) {
		const auto frontier = fitFrontier(sample(seed, bend, noise), begin, end, 1.0, noise);
		EXPECT_TRUE(frontier);
		if (!frontier)
			continue;
		found.mean += frontier->value / seeds;
		found.rms += frontier->value * frontier->value / seeds;
		found.claimed += frontier->deviation / seeds;
	}
	found.rms = std::sqrt(found.rms);
	return found;
}

TEST(Frontier, EndsWhereASampleEnds)
{
	for (const double bend : {0.0, -0.01, 0.01}) {
		const Errors exact = errors(bend, 0.0), noisy = errors(bend, 0.5);
		EXPECT_LT(std::abs(exact.mean), 0.05) << bend;
		EXPECT_LT(exact.rms, 0.15) << bend;
		EXPECT_LT(std::abs(noisy.mean), 0.1) << bend;
		EXPECT_LT(noisy.rms, 0.25) << bend;
	}
}

TEST(Frontier, EndsThereAtTheEndOfItsWindowToo)
{
	for (const double noise : {0.0, 0.5}) {
		const Errors left  = errors(-0.005, noise, 0.0, reach),
					 right = errors(-0.005, noise, -reach, 0.0);
		EXPECT_LT(left.rms, 0.6) << noise;
		EXPECT_LT(right.rms, 0.6) << noise;
	}
}

TEST(Frontier, KnowsItsError)
{
	for (const double noise : {0.0, 0.5, 1.0}) {
		const Errors found = errors(0.0, noise);
		EXPECT_LT(found.rms, 1.6 * found.claimed) << noise;
		EXPECT_GT(found.rms, 0.6 * found.claimed) << noise;
	}
}

TEST(Frontier, FollowsAFrontierThatWinds)
{
	const double                 wavelength = 60.0, height = 2.0;
	Random                       random(5, 0);
	std::vector<Eigen::Vector2d> points;
	const auto                   at = [&](double s) {
        return height * std::cos(2.0 * double(EIGEN_PI) * s / wavelength);
	};
	for (int k = 0; k < 2400; ++k) {
		const double s = random.uniform(-60.0, 60.0), x = random.uniform(-10.0, 10.0);
		if (x < at(s))
			points.emplace_back(s, x);
	}
	const auto found = fitFrontier(
		Eigen::Map<Matrix2Xd>(points[0].data(), 2, points.size()), -60.0, 60.0, 1.0, 0.0);
	ASSERT_TRUE(found);
	EXPECT_NEAR(found->value, height, 0.4);
}

TEST(Frontier, IsNotMovedByAFewStrays)
{
	Matrix2Xd  points = sample(1, 0.0, 0.0);
	const auto alone  = fitFrontier(points, -reach, reach, 1.0, 0.0);
	points.conservativeResize(2, points.cols() + 2);
	points.rightCols(2) << 1.0, -9.0, 4.0, 6.0;
	const auto found = fitFrontier(points, -reach, reach, 1.0, 0.0);
	ASSERT_TRUE(alone && found);
	EXPECT_NEAR(found->value, alone->value, 0.2);
}

TEST(Frontier, ScalesWithTheSample)
{
	const Matrix2Xd points = sample(2, -0.01, 0.3);
	const auto      unit   = fitFrontier(points, -reach, reach, 1.0, 0.3);
	for (const double scale : {1e-9, 1e9}) {
		const auto found = fitFrontier(
			scale * points, -scale * reach, scale * reach, 1.0 / (scale * scale), 0.3 * scale);
		ASSERT_TRUE(unit && found);
		EXPECT_NEAR(found->value / scale, unit->value, 1e-6);
		EXPECT_NEAR(found->slope, unit->slope, 1e-6);
	}
}

TEST(Frontier, IsNotToldByTooFewPoints)
{
	EXPECT_FALSE(fitFrontier(Matrix2Xd(2, 0), -1.0, 1.0, 1.0, 0.0));
	EXPECT_FALSE(fitFrontier(sample(3, 0.0, 0.0), 0.0, 0.0, 1.0, 0.0));
	EXPECT_FALSE(fitFrontier(sample(3, 0.0, 0.0), 2.0 * reach, 3.0 * reach, 1.0, 0.0));
}

} // namespace
} // namespace curvature_lines::test
