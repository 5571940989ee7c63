// Normal equations from moments: of sum w x^a y^b there are far fewer than of products of monomials.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_polynomial.h"

#include <array>

#include <Eigen/Cholesky>

namespace curvature_lines {

namespace {

template<int Degree, int Values>
struct Moments {
	double weighted[2 * Degree + 1][2 * Degree + 1]; // sum w x^a y^b
	double products[Degree + 1][Degree + 1][Values]; // sum w x^a y^b value
	double squares;                                  // sum w |value|^2
};

template<int Degree, int Values>
CURVATURE_LINES_AVX2_CLONE void
accumulate(const LocalSamples<Values>& samples, int padded, Moments<Degree, Values>& result)
{
	constexpr int highest                                  = 2 * Degree;
	Block         weighted[highest + 1][highest + 1]       = {};
	Block         products[Degree + 1][Degree + 1][Values] = {};
	Block         squares                                  = {};
	for (int s = 0; s < padded; s += blockSize) {
		const Block x = blockAt(&samples.x[s]);
		const Block y = blockAt(&samples.y[s]);
		Block       v[Values];
		Block       power = blockAt(&samples.weight[s]); // w x^a
		for (int c = 0; c < Values; ++c) {
			v[c] = blockAt(&samples.value[c][s]);
			squares += power * v[c] * v[c];
		}
#pragma GCC unroll 16
		for (int a = 0; a <= highest; ++a) {
			Block both = power; // w x^a y^b
#pragma GCC unroll 16
			for (int b = 0; b <= highest - a; ++b) {
				weighted[a][b] += both;
				if (a + b <= Degree)
					for (int c = 0; c < Values; ++c)
						products[a][b][c] += both * v[c];
				both *= y;
			}
			power *= x;
		}
	}
	for (int a = 0; a <= highest; ++a)
		for (int b = 0; a + b <= highest; ++b)
			result.weighted[a][b] = sumOf(weighted[a][b]);
	for (int a = 0; a <= Degree; ++a)
		for (int b = 0; a + b <= Degree; ++b)
			for (int c = 0; c < Values; ++c)
				result.products[a][b][c] = sumOf(products[a][b][c]);
	result.squares = sumOf(squares);
}

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
	constexpr int           count    = monomialCount(Degree);
	constexpr auto          exponent = exponents<Degree>();
	Moments<Degree, Values> moments;
	accumulate<Degree, Values>(samples, samples.pad(), moments);

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
	regular.diagonal() *= 1.0 + 1e-10; // a sheet seen edge-on still has a solution
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
