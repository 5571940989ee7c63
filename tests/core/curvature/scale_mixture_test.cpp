// Shares of scales whose risks are known, and the variance of a mixture where the noise differs from place to place.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_mixture.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "half_sample_risk.h"
#include "made_up_trials.h"
#include "point_cloud.h"

namespace curvature_lines::test {
namespace {

// Scales of the same radius, so that none tells the bias of another: the risk is the variance.
std::vector<MadeUpScale> scalesOf(const std::vector<double>& deviations)
{
	std::vector<MadeUpScale> scales(deviations.size());
	for (std::size_t c = 0; c < deviations.size(); ++c)
		scales[c].deviation = deviations[c];
	return scales;
}

TEST(ScaleMixture, SharesFallWithTheFourthPowerOfTheRisk)
{
	const auto               trials = trialsOf(scalesOf({0.23, 0.2, 0.3}), 3000);
	const std::vector<Index> pool   = firstProbes(3000);
	const HalfSampleRisk     risks(trials, pool);
	const ScaleMixture       mixture = mixtureOf(risks);
	ASSERT_EQ(
		mixture.weights.size(), 2u); // the risk of the third is 2.25 times the least one: 1/26
	EXPECT_EQ(mixture.weights[0].first, 1);
	EXPECT_EQ(mixture.weights[1].first, 0);
	const double ratio = risks.risk()[1] / risks.risk()[0];
	EXPECT_NEAR(
		mixture.weights[1].second / mixture.weights[0].second,
		ratio * ratio * ratio * ratio,
		1e-12);
	EXPECT_NEAR(mixture.weights[0].second + mixture.weights[1].second, 1.0, 1e-12);
	EXPECT_NEAR(
		mixture.variance,
		mixture.weights[0].second * risks.variance()[1] +
			mixture.weights[1].second * risks.variance()[0],
		1e-12);
}

TEST(ScaleMixture, IsOfFourScalesAtMostAndOfNoneThatIsNotValid)
{
	const auto               trials = trialsOf(scalesOf({0.2, 0.2, 0.2, 0.2, 0.2, 0.2}), 1000);
	const std::vector<Index> pool = firstProbes(1000), few = firstProbes(4);
	const ScaleMixture       mixture = mixtureOf(HalfSampleRisk(trials, pool));
	ASSERT_EQ(mixture.weights.size(), 4u);
	for (std::size_t k = 1; k < 4; ++k)
		EXPECT_LE(mixture.weights[k].second, mixture.weights[k - 1].second);
	EXPECT_TRUE(mixtureOf(HalfSampleRisk(trials, few)).weights.empty());
}

// The median of few differences stands for the mean of many.
TEST(ScaleMixture, VarianceIsThatOfThePlace)
{
	const double             quiet = 0.1, noisy = 0.4;
	std::vector<MadeUpScale> scales = scalesOf({quiet});
	const auto               calm   = trialsOf(scales, 4000);
	scales                          = scalesOf({noisy});
	const auto               wild   = trialsOf(scales, 4000);
	const std::vector<Index> near   = firstProbes(4000);
	ScaleMixture             mixture;
	mixture.weights  = {{0, 1.0}};
	mixture.variance = 7.0;
	// Six degrees of freedom here, whose median is 0.89 of the mean; three, as in tangent planes, have 0.79.
	const double six = 0.891 / 0.79;
	EXPECT_NEAR(varianceAround(calm, near, mixture) / (six * 3.0 * quiet * quiet), 1.0, 0.1);
	EXPECT_NEAR(varianceAround(wild, near, mixture) / (six * 3.0 * noisy * noisy), 1.0, 0.1);
	EXPECT_EQ(varianceAround(calm, {}, mixture), 7.0); // no estimate there: that of the region
}

} // namespace
} // namespace curvature_lines::test
