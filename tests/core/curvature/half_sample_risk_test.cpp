// The risk of scales whose bias and variance are known, and which scales are not valid.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_sample_risk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "made_up_trials.h"
#include "point_cloud.h"
#include "scale_trials.h"

namespace curvature_lines::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Bias as the fourth power of the radius, deviation falling with it.
std::vector<MadeUpScale> ladder(int levels)
{
	ShapeVector direction;
	direction << 1.0, -2.0, 0.5, 1.5, 0.0, 1.0;
	std::vector<MadeUpScale> scales(levels);
	for (int level = 0; level < levels; ++level) {
		const double size       = std::pow(1.3, level);
		scales[level].radius    = 0.03 * size;
		scales[level].level     = level;
		scales[level].bias      = 0.001 * std::pow(size, 4) * direction;
		scales[level].deviation = 0.5 / (size * size * size);
	}
	return scales;
}

TEST(HalfSampleRisk, IsVariancePlusSquaredBias)
{
	const std::vector<MadeUpScale> scales = ladder(8);
	const auto                     trials = trialsOf(scales, 2000);
	const std::vector<Index>       pool   = firstProbes(2000);
	const HalfSampleRisk           risks(trials, pool);
	ASSERT_EQ(risks.risk().size(), scales.size());
	for (std::size_t c = 0; c < scales.size(); ++c) {
		// Without its largest 5 % the mean of a chi-square of six degrees of freedom is 0.9 of the whole.
		EXPECT_GT(risks.variance()[c], 0.85 * scales[c].variance()) << c;
		EXPECT_LT(risks.variance()[c], 0.95 * scales[c].variance()) << c;
		EXPECT_DOUBLE_EQ(risks.residual()[c], scales[c].residual);
		// Below the variance noise leaves little of it to be seen.
		const double squaredBias = risks.risk()[c] - risks.variance()[c];
		if (scales[c].bias.squaredNorm() > scales[c].variance()) {
			EXPECT_NEAR(squaredBias / scales[c].bias.squaredNorm(), 1.0, 0.1) << c;
		}
	}
}

TEST(HalfSampleRisk, FindsTheBestScale)
{
	const std::vector<MadeUpScale> scales = ladder(10);
	const auto                     trials = trialsOf(scales, 1500);
	const std::vector<Index>       pool   = firstProbes(1500);
	const HalfSampleRisk           risks(trials, pool);
	double                         least = infinity;
	for (const MadeUpScale& scale : scales)
		least = std::min(least, scale.risk());
	ASSERT_GT(scales.front().risk(), 10.0 * least);
	ASSERT_GT(scales.back().risk(), 10.0 * least);
	EXPECT_LT(scales[risks.best()].risk(), 1.2 * least);
	EXPECT_EQ(risks.leastRisk(), risks.risk()[risks.best()]);
}

TEST(HalfSampleRisk, CountsOnlyThePool)
{
	std::vector<MadeUpScale> scales(1);
	scales[0].deviation = 0.1;
	auto            two = trialsOf(scales, 400);
	samples::Random random(3, 0);
	scales[0].deviation  = 0.3;
	const ScaleTrial far = trialOf(scales[0], 400, random);
	for (int h = 0; h < 2; ++h)
		std::copy(far.halves[h].begin() + 200, far.halves[h].end(), two[0].halves[h].begin() + 200);
	const std::vector<Index> pool = firstProbes(200);
	std::vector<Index>       rest;
	for (Index p = 200; p < 400; ++p)
		rest.push_back(p);
	EXPECT_NEAR(
		HalfSampleRisk(two, rest).variance()[0] / HalfSampleRisk(two, pool).variance()[0],
		9.0,
		2.0);
}

// In a ball no thicker than the noisy layer noise looks like shape.
TEST(HalfSampleRisk, ScalesWithinTheNoiseAreNotValid)
{
	std::vector<MadeUpScale> scales = ladder(6);
	for (int level = 0; level < 6; ++level)
		scales[level].residual = level < 2 ? 0.18 : level == 2 ? 0.22 : 0.1;
	const auto               trials = trialsOf(scales, 300);
	const std::vector<Index> pool   = firstProbes(300);
	const HalfSampleRisk     risks(trials, pool);
	for (std::size_t c = 0; c < 6; ++c) {
		EXPECT_EQ(risks.risk()[c] < infinity, c > 2) << c;
		EXPECT_EQ(risks.variance()[c] < infinity, c > 2) << c;
	}
}

TEST(HalfSampleRisk, AScaleTooLargeForTheShapeLeavesFinerOnesValid)
{
	std::vector<MadeUpScale> scales = ladder(6);
	scales[4].residual              = 0.25;
	const auto               trials = trialsOf(scales, 300);
	const std::vector<Index> pool   = firstProbes(300);
	const HalfSampleRisk     risks(trials, pool);
	for (std::size_t c = 0; c < 6; ++c)
		EXPECT_EQ(risks.risk()[c] < infinity, c != 4) << c;
}

TEST(HalfSampleRisk, AsksForEnoughEstimates)
{
	auto       trials = trialsOf(ladder(3), 100);
	const auto spoil  = [&](Index count) {
        for (Index p = 0; p < count; ++p)
            trials[1].halves[p % 2][p].valid = false;
	};
	const std::vector<Index> pool = firstProbes(100), few = firstProbes(7);
	spoil(12); // less than an eighth
	EXPECT_LT(HalfSampleRisk(trials, pool).risk()[1], infinity);
	spoil(13);
	const HalfSampleRisk risks(trials, pool);
	EXPECT_EQ(risks.risk()[1], infinity);
	EXPECT_LT(risks.risk()[0], infinity);
	EXPECT_EQ(HalfSampleRisk(trials, few).leastRisk(), infinity);
}

} // namespace
} // namespace curvature_lines::test
