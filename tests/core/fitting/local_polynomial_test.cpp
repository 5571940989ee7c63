// The polynomial fit against a QR decomposition of its design matrix, and what it does without enough data.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "local_polynomial.h"
#include "monomials.h"

namespace curvature_lines {
namespace {

// Random places in the unit disk, weights with some zeros, values without any structure.
template<int Values>
LocalSamples<Values> randomSamples(int count, int seed)
{
	samples::Random      random(seed, 0);
	LocalSamples<Values> samples;
	samples.reserve(count);
	for (int s = 0; s < count; ++s) {
		Eigen::Matrix<double, Values, 1> value;
		for (int c = 0; c < Values; ++c)
			value[c] = random.normal();
		const double angle  = random.uniform(0.0, 2.0 * EIGEN_PI),
					 radius = std::sqrt(random.uniform());
		const double weight = s % 7 == 3 ? 0.0 : random.uniform(0.05, 1.0);
		samples.add(radius * std::cos(angle), radius * std::sin(angle), weight, value);
	}
	return samples;
}

template<int Degree, int Values>
void expectAgreesWithQr(int count, int seed)
{
	constexpr int        terms   = monomialCount(Degree);
	LocalSamples<Values> samples = randomSamples<Values>(count, seed);
	Eigen::MatrixXd      design(count, terms), values(count, Values);
	for (int s = 0; s < count; ++s) {
		const double root = std::sqrt(samples.weight[s]);
		int          m    = 0;
		for (int degree = 0; degree <= Degree; ++degree)
			for (int b = 0; b <= degree; ++b)
				design(s, m++) =
					root * std::pow(samples.x[s], degree - b) * std::pow(samples.y[s], b);
		for (int c = 0; c < Values; ++c)
			values(s, c) = root * samples.value[c][s];
	}
	const Eigen::MatrixXd expected = design.colPivHouseholderQr().solve(values);
	const auto            fit      = fitPolynomial<Degree, Values>(samples);
	ASSERT_TRUE(fit.valid) << Degree << " " << count;
	EXPECT_LT((fit.coefficients - expected).norm(), 1e-6 * (1.0 + expected.norm()))
		<< Degree << " " << count;
	EXPECT_NEAR(
		fit.squaredResidual,
		(values - design * expected).squaredNorm(),
		1e-6 * values.squaredNorm());
	EXPECT_LT((fit.gram - design.transpose() * design).norm(), 1e-12 * fit.gram.norm());
	EXPECT_NEAR(
		fit.sumOfWeights, (design.col(0).array() * design.col(0).array()).sum(), 1e-12 * count);
}

TEST(LocalPolynomial, AgreesWithQrOfTheDesignMatrix)
{
	for (const int count : {60, 61, 62, 63, 300}) { // every remainder of the block size
		expectAgreesWithQr<1, 1>(count, count);
		expectAgreesWithQr<2, 1>(count, count);
		expectAgreesWithQr<2, 10>(count, count);
		expectAgreesWithQr<3, 3>(count, count);
		expectAgreesWithQr<4, 1>(count, count);
	}
}

TEST(LocalPolynomial, ReproducesPolynomialsOfItsDegree)
{
	LocalSamples<1> samples = randomSamples<1>(50, 1);
	const auto      height  = [](double x, double y) {
        return 0.3 - 0.2 * x + y + 0.5 * x * x - x * y + 2.0 * y * y + x * x * x -
               0.7 * x * y * y * y;
	};
	for (int s = 0; s < samples.size(); ++s)
		samples.value[0][s] = height(samples.x[s], samples.y[s]);
	const auto fit = fitPolynomial<4, 1>(samples);
	ASSERT_TRUE(fit.valid);
	double squares = 0.0;
	for (int s = 0; s < samples.size(); ++s)
		squares += samples.weight[s] * samples.value[0][s] * samples.value[0][s];
	EXPECT_LT(fit.squaredResidual, 1e-9 * squares); // the difference of two sums of this size
	for (const double x : {-0.5, 0.0, 0.3})
		for (const double y : {-0.4, 0.0, 0.6})
			EXPECT_NEAR(fit(x, y)[0], height(x, y), 1e-7);
}

TEST(LocalPolynomial, PaddingOfAnEarlierAndLargerSetDoesNotCount)
{
	LocalSamples<1> reused = randomSamples<1>(200, 2), fresh = randomSamples<1>(30, 3);
	reused.reserve(30);
	for (int s = 0; s < 30; ++s)
		reused.add(
			fresh.x[s],
			fresh.y[s],
			fresh.weight[s],
			Eigen::Matrix<double, 1, 1>(fresh.value[0][s]));
	const auto a = fitPolynomial<2, 1>(reused), b = fitPolynomial<2, 1>(fresh);
	EXPECT_EQ(a.coefficients, b.coefficients);
	EXPECT_EQ(a.squaredResidual, b.squaredResidual);
}

TEST(LocalPolynomial, TooFewOrWeightlessSamplesAreInvalid)
{
	LocalSamples<1> empty;
	empty.reserve(0);
	EXPECT_FALSE((fitPolynomial<2, 1>(empty).valid));
	LocalSamples<1> five = randomSamples<1>(5, 1);
	EXPECT_FALSE((fitPolynomial<2, 1>(five).valid));
	LocalSamples<1> weightless = randomSamples<1>(40, 1);
	std::fill(weightless.weight.begin(), weightless.weight.end(), 0.0);
	EXPECT_FALSE((fitPolynomial<2, 1>(weightless).valid));
}

// Undetermined, but what is there is fitted and nothing blows up.
TEST(LocalPolynomial, SamplesOnALineGiveFiniteValuesOnIt)
{
	LocalSamples<1> samples;
	samples.reserve(41);
	for (int s = -20; s <= 20; ++s)
		samples.add(s / 20.0, s / 40.0, 1.0, Eigen::Matrix<double, 1, 1>(s / 20.0));
	const auto fit = fitPolynomial<2, 1>(samples);
	if (fit.valid) {
		EXPECT_NEAR(fit(0.5, 0.25)[0], 0.5, 1e-4);
	}
	EXPECT_TRUE(std::isfinite(fit.squaredResidual));
}

} // namespace
} // namespace curvature_lines
