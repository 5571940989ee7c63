// Weighted least squares of a polynomial in the tangent plane to values at scattered points: the fit that
// the adaptive curvature, the outlier votes and the denoising have in common.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace curvature_lines {

// Monomials x^a y^b of the whole degree, in the order 1, x, y, x^2, x y, y^2, x^3, ...
constexpr int monomialCount(int degree)
{
	return (degree + 1) * (degree + 2) / 2;
}

// Points in the tangent plane, weights and values, one array per component so that sums vectorise. Lengths
// are best in units of the neighbourhood's radius. Kept by the caller as the scratch of one thread.
template<int Values>
class LocalSamples {
public:
	static constexpr int block = 4;

	std::vector<double> x, y, weight;
	std::vector<double> value[Values];

	// Room for n samples and the padding of the last block.
	void reserve(std::size_t n)
	{
		if (x.size() < n + block) {
			for (auto* array : {&x, &y, &weight})
				array->resize(n + block);
			for (auto& array : value)
				array.resize(n + block);
		}
		m_size = 0;
	}
	int  size() const { return m_size; }
	void add(double px, double py, double w, const Eigen::Matrix<double, Values, 1>& values)
	{
		x[m_size]      = px;
		y[m_size]      = py;
		weight[m_size] = w;
		for (int c = 0; c < Values; ++c)
			value[c][m_size] = values[c];
		++m_size;
	}
	// Samples of weight 0 up to a whole number of blocks; returns the padded size.
	int pad()
	{
		int padded = m_size;
		for (; padded % block != 0; ++padded) {
			x[padded] = y[padded] = weight[padded] = 0.0;
			for (auto& array : value)
				array[padded] = 0.0;
		}
		return padded;
	}

private:
	int m_size = 0;
};

template<int Degree, int Values>
struct PolynomialFit {
	static constexpr int count = monomialCount(Degree);

	Eigen::Matrix<double, count, Values> coefficients;
	Eigen::Matrix<double, count, count>  gram; // sum w phi phi^T
	double                               sumOfWeights    = 0.0;
	double                               squaredResidual = 0.0; // sum w |value - polynomial|^2
	bool                                 valid           = false;

	static Eigen::Matrix<double, count, 1> monomials(double x, double y)
	{
		Eigen::Matrix<double, count, 1> phi;
		int                             m = 0;
		for (int degree = 0; degree <= Degree; ++degree)
			for (int b = 0; b <= degree; ++b, ++m) {
				double product = 1.0;
				for (int t = 0; t < degree - b; ++t)
					product *= x;
				for (int t = 0; t < b; ++t)
					product *= y;
				phi[m] = product;
			}
		return phi;
	}
	Eigen::Matrix<double, Values, 1> operator()(double x, double y) const
	{
		return coefficients.transpose() * monomials(x, y);
	}
};

// Invalid when the samples do not determine the polynomial. The normal equations come from the moments
// sum w x^a y^b, of which there are far fewer than products of monomials.
template<int Degree, int Values>
PolynomialFit<Degree, Values> fitPolynomial(LocalSamples<Values>& samples)
{
	using Block             = Eigen::Array<double, LocalSamples<Values>::block, 1>;
	constexpr int   highest = 2 * Degree;
	constexpr int   count   = monomialCount(Degree);
	Block           moments[highest + 1][highest + 1];
	Block           products[Degree + 1][Degree + 1][Values];
	Block           squares = Block::Zero();
	const int       padded  = samples.pad();
	for (auto& row : moments)
		for (Block& moment : row)
			moment.setZero();
	for (auto& row : products)
		for (auto& cell : row)
			for (Block& product : cell)
				product.setZero();
	for (int s = 0; s < padded; s += LocalSamples<Values>::block) {
		const Block x = Eigen::Map<const Block>(&samples.x[s]);
		const Block y = Eigen::Map<const Block>(&samples.y[s]);
		Block       v[Values];
		Block       power = Eigen::Map<const Block>(&samples.weight[s]); // w x^a
		for (int c = 0; c < Values; ++c) {
			v[c] = Eigen::Map<const Block>(&samples.value[c][s]);
			squares += power * v[c] * v[c];
		}
		for (int a = 0; a <= highest; ++a) {
			Block both = power; // w x^a y^b
			for (int b = 0; a + b <= highest; ++b) {
				moments[a][b] += both;
				if (a + b <= Degree)
					for (int c = 0; c < Values; ++c)
						products[a][b][c] += both * v[c];
				both *= y;
			}
			power *= x;
		}
	}

	PolynomialFit<Degree, Values>        fit;
	Eigen::Matrix<double, count, Values> rhs;
	int                                  exponent[count][2];
	for (int degree = 0, m = 0; degree <= Degree; ++degree)
		for (int b = 0; b <= degree; ++b, ++m) {
			exponent[m][0] = degree - b;
			exponent[m][1] = b;
		}
	for (int r = 0; r < count; ++r) {
		for (int c = 0; c < Values; ++c)
			rhs(r, c) = products[exponent[r][0]][exponent[r][1]][c].sum();
		for (int c = 0; c <= r; ++c)
			fit.gram(r, c) = fit.gram(c, r) =
				moments[exponent[r][0] + exponent[c][0]][exponent[r][1] + exponent[c][1]].sum();
	}
	fit.sumOfWeights = fit.gram(0, 0);
	if (samples.size() < count || !(fit.sumOfWeights > 0.0))
		return fit;
	Eigen::Matrix<double, count, count> regular = fit.gram;
	regular.diagonal() *= 1.0 + 1e-10; // a sheet seen edge-on still has a solution
	const Eigen::LDLT<Eigen::Matrix<double, count, count>> ldlt(regular);
	fit.coefficients    = ldlt.solve(rhs);
	fit.squaredResidual = std::max(0.0, squares.sum() - fit.coefficients.cwiseProduct(rhs).sum());
	fit.valid           = ldlt.isPositive() && fit.coefficients.allFinite();
	return fit;
}

} // namespace curvature_lines
