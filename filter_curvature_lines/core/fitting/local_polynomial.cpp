// Normal equations from moments: of sum w x^a y^b there are far fewer than of products of monomials.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_polynomial.h"

#include <algorithm>
#include <array>

#include <Eigen/Cholesky>

#include "monomials.h"
#include "sample_kernels.h"

namespace curvature_lines {

namespace {

// Powers of x and y of every monomial.
template<int Degree>
constexpr std::array<std::array<int, 2>, monomialCount(Degree)> exponents()
{
	std::array<std::array<int, 2>, monomialCount(Degree)> result = {};
	for (int degree = 0, m = 0; degree <= Degree; ++degree)
		for (int b = 0; b <= degree; ++b, ++m) {
			result[m][0] = degree - b;
			result[m][1] = b;
		}
	return result;
}

} // namespace

template<int Degree, int Values>
PolynomialFit<Degree, Values> fitPolynomial(LocalSamples<Values>& samples)
{
	constexpr int  count    = monomialCount(Degree);
	constexpr auto exponent = exponents<Degree>();
	samples.pad();
	const Moments<Degree, Values> moments = momentsOf<Degree, Values>(samples.columns());

	PolynomialFit<Degree, Values>        fit;
	Eigen::Matrix<double, count, Values> rhs;
	for (int r = 0; r < count; ++r) {
		for (int c = 0; c < Values; ++c)
			rhs(r, c) = moments.products[exponent[r][0]][exponent[r][1]][c];
		for (int c = 0; c <= r; ++c)
			fit.gram(r, c) = fit.gram(c, r) =
				moments.weighted[exponent[r][0] + exponent[c][0]][exponent[r][1] + exponent[c][1]];
	}
	fit.sumOfWeights = fit.gram(0, 0);
	if (samples.size() < count || !(fit.sumOfWeights > 0.0))
		return fit;
	Eigen::Matrix<double, count, count> regular = fit.gram;
	regular.diagonal() *= 1.0 + 1e-10; // samples along one line still have a solution
	const Eigen::LDLT<Eigen::Matrix<double, count, count>> ldlt(regular);
	fit.coefficients    = ldlt.solve(rhs);
	fit.squaredResidual = std::max(0.0, moments.squares - fit.coefficients.cwiseProduct(rhs).sum());
	fit.valid           = ldlt.isPositive() && fit.coefficients.allFinite();
	return fit;
}

template PolynomialFit<1, 1> fitPolynomial(LocalSamples<1>&);
template PolynomialFit<2, 1> fitPolynomial(LocalSamples<1>&);
template PolynomialFit<4, 1> fitPolynomial(LocalSamples<1>&);
template PolynomialFit<1, 3> fitPolynomial(LocalSamples<3>&);
template PolynomialFit<2, 3> fitPolynomial(LocalSamples<3>&);
template PolynomialFit<3, 3> fitPolynomial(LocalSamples<3>&);
template PolynomialFit<2, 10> fitPolynomial(LocalSamples<10>&);

} // namespace curvature_lines
