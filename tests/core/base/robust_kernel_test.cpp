// The robust cost and its weight.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "robust_kernel.h"

namespace curvature_lines {
namespace {

TEST(RobustKernel, TheWeightIsTheDerivativeOfTheCostOverTheResidual)
{
	for (double t = 0.01; t < 20.0; t *= 1.3) {
		const double h          = 1e-6 * t;
		const double derivative = (gemanMcClureCost(t + h) - gemanMcClureCost(t - h)) / (2.0 * h);
		EXPECT_NEAR(gemanMcClureWeight(t), derivative / t, 1e-6 * (1.0 + derivative / t));
	}
	EXPECT_EQ(gemanMcClureWeight(0.0), 2.0);
}

TEST(RobustKernel, TheRelativeWeightIsTheWeightOverThatOfZero)
{
	for (double t = 0.0; t < 20.0; t += 0.37) {
		EXPECT_EQ(
			relativeGemanMcClureWeight(t * t), gemanMcClureWeight(t) / gemanMcClureWeight(0.0));
		EXPECT_NEAR(gemanMcClureDivisor(t * t) * relativeGemanMcClureWeight(t * t), 1.0, 1e-15);
	}
	EXPECT_EQ(relativeGemanMcClureWeight(1.0), 0.25);
}

// Half of a normal distribution lies within its median of |r|.
TEST(RobustKernel, TheDeviationIsThatOfANormalDistribution)
{
	const double within = std::erf(1.0 / deviationOverMedian / std::sqrt(2.0));
	EXPECT_NEAR(within, 0.5, 1e-5);
}

TEST(RobustKernel, IsEvenAndBoundedAndGrows)
{
	double before = -1.0;
	for (double t = 0.0; t < 100.0; t += 0.37) {
		EXPECT_EQ(gemanMcClureCost(t), gemanMcClureCost(-t));
		EXPECT_EQ(gemanMcClureWeight(t), gemanMcClureWeight(-t));
		EXPECT_GT(gemanMcClureCost(t), before);
		EXPECT_LT(gemanMcClureCost(t), 1.0);
		before = gemanMcClureCost(t);
	}
}

} // namespace
} // namespace curvature_lines
