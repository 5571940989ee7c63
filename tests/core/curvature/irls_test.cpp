// The re-weighted fit of normal variations against closed forms: exact models, outliers, weights and their scale.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "irls.h"
#include "point_cloud.h"
#include "robust_kernel.h"

namespace curvature_lines {
namespace {

VariationModel someModel()
{
	VariationModel model;
	model << 1.2, -0.3, -0.3, 0.4, 0.1, -0.2;
	return model;
}

// Samples of `model`, with noise, a share of which follow another one.
VariationSamples
samplesOf(const VariationModel& model, int count, double noise, double outliers, std::uint64_t seed)
{
	samples::Random  random(seed, 0);
	VariationSamples samples;
	for (int k = 0; k < count; ++k) {
		const Eigen::Vector2d dp(random.uniform(-1, 1), random.uniform(-1, 1));
		Eigen::Vector3d       dn = model * dp + noise * random.normal3();
		if (random.uniform() < outliers)
			dn = 3.0 * random.normal3();
		samples.add(0, k + 1, dp, dn, 1.0 / (0.1 + dp.squaredNorm()));
	}
	return samples;
}

TEST(Irls, WeightedLeastSquaresSolvesTheNormalEquations)
{
	const VariationSamples samples = samplesOf(someModel(), 40, 0.3, 0.0, 1);
	samples::Random        random(2, 0);
	std::vector<double>    weights(samples.size());
	for (double& w : weights)
		w = random.uniform(0.0, 2.0);
	const VariationModel found = weightedLeastSquares(samples, weights);
	Eigen::MatrixXd      a(samples.size(), 2), b(samples.size(), 3);
	for (Index s = 0; s < samples.size(); ++s) {
		const double root = std::sqrt(weights[s] * samples.geometric[s]);
		a.row(s) << root * samples.pu[s], root * samples.pv[s];
		b.row(s) << root * samples.nu[s], root * samples.nv[s], root * samples.nw[s];
	}
	const Eigen::MatrixXd oracle = a.colPivHouseholderQr().solve(b);
	EXPECT_LT((found - oracle.transpose()).norm(), 1e-9);
}

TEST(Irls, FindsAnExactModel)
{
	IrlsSolver     solver;
	const IrlsFit& fit =
		solver.fit(samplesOf(someModel(), 60, 0.0, 0.0, 3), VariationModel::Zero(), {});
	EXPECT_LT((fit.model - someModel()).norm(), 1e-6);
	EXPECT_NEAR(fit.sigma, exactResidual, 1e-6);
	ASSERT_EQ(fit.weights.size(), 60u);
	for (const double w : fit.weights)
		EXPECT_GT(w, 1.0);
}

TEST(Irls, OutliersHaveNoSay)
{
	const VariationSamples samples = samplesOf(someModel(), 400, 0.02, 0.35, 4);
	IrlsSolver             solver;
	IrlsOptions            plain;
	plain.robust        = false;
	plain.maxIterations = 1;
	const double leastError =
		(solver.fit(samples, VariationModel::Zero(), plain).model - someModel()).norm();
	const IrlsFit& fit = solver.fit(samples, VariationModel::Zero(), {});
	EXPECT_LT((fit.model - someModel()).norm(), 0.02);
	EXPECT_LT((fit.model - someModel()).norm(), 0.2 * leastError);
	const auto cut = std::count(fit.weights.begin(), fit.weights.end(), 0.0);
	EXPECT_NEAR(cut, 0.35 * 400, 40);
}

TEST(Irls, SigmaAndWeightsAreThoseOfTheResiduals)
{
	const VariationSamples samples = samplesOf(someModel(), 301, 0.1, 0.1, 5);
	IrlsSolver             solver;
	const IrlsOptions      options;
	const IrlsFit&         fit = solver.fit(samples, VariationModel::Zero(), options);
	std::vector<double>    residuals;
	for (Index s = 0; s < samples.size(); ++s) {
		const Eigen::Vector2d dp(samples.pu[s], samples.pv[s]);
		const Eigen::Vector3d dn(samples.nu[s], samples.nv[s], samples.nw[s]);
		residuals.push_back((fit.model * dp - dn).norm());
		EXPECT_NEAR(solver.squaredResiduals()[s], std::pow(residuals.back(), 2), 1e-9);
	}
	std::vector<double> sorted = residuals;
	std::sort(sorted.begin(), sorted.end());
	EXPECT_NEAR(fit.sigma, options.sigmaFactor * sorted[150], 1e-9);
	for (Index s = 0; s < samples.size(); ++s) {
		const double t = residuals[s] / fit.sigma;
		EXPECT_NEAR(fit.weights[s], t > options.cut ? 0.0 : gemanMcClureWeight(t), 1e-6);
	}
}

TEST(Irls, SamplesOnALineDetermineNoModel)
{
	VariationSamples samples = samplesOf(someModel(), 10, 0.0, 0.0, 6);
	EXPECT_TRUE(samples.spanPlane());
	samples.clear();
	EXPECT_EQ(samples.size(), 0);
	for (int k = 1; k < 10; ++k)
		samples.add(0, k, {0.1 * k, 0.2 * k}, {1, 0, 0}, 1.0);
	EXPECT_FALSE(samples.spanPlane());
}

} // namespace
} // namespace curvature_lines
