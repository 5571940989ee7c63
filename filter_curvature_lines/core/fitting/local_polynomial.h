// Weighted least squares of a polynomial in the tangent plane to values at scattered points: the fit that
// the adaptive curvature, the outlier votes and the denoising have in common.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "block_size.h"
#include "monomials.h"
#include "sample_kernels.h"

namespace curvature_lines {

// Points in the tangent plane, weights and values, one array per component so that sums vectorise. Lengths
// are best in units of the neighbourhood's radius. Kept by the caller as the scratch of one thread.
template<int Values>
class LocalSamples {
public:
	std::vector<double> x, y, weight;
	std::vector<double> value[Values];

	// Room for n samples and the padding of the last block.
	void reserve(std::size_t n)
	{
		if (x.size() < n + blockSize) {
			for (auto* array : {&x, &y, &weight})
				array->resize(n + blockSize);
			for (auto& array : value)
				array.resize(n + blockSize);
		}
		m_size = 0;
	}
	// n samples that the caller writes into the arrays.
	void resize(std::size_t n)
	{
		reserve(n);
		m_size = int(n);
	}
	int size() const { return m_size; }
	void add(double px, double py, double w, const Eigen::Matrix<double, Values, 1>& values)
	{
		x[m_size]      = px;
		y[m_size]      = py;
		weight[m_size] = w;
		for (int c = 0; c < Values; ++c)
			value[c][m_size] = values[c];
		++m_size;
	}
	// The arrays as the kernels take them.
	SampleColumns<Values> columns()
	{
		SampleColumns<Values> result{x.data(), y.data(), weight.data(), {}, m_size};
		for (int c = 0; c < Values; ++c)
			result.value[c] = value[c].data();
		return result;
	}
	// Samples of weight 0 up to a whole number of blocks; returns the padded size.
	int pad()
	{
		int padded = m_size;
		for (; padded % blockSize != 0; ++padded) {
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

// Invalid when the samples do not determine the polynomial. Compiled for the degrees and numbers of values
// that are in use, see the end of local_polynomial.cpp.
template<int Degree, int Values>
PolynomialFit<Degree, Values> fitPolynomial(LocalSamples<Values>& samples);

} // namespace curvature_lines
