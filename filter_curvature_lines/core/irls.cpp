// M-estimation of the variation model (A09 section 3, eq. 1): scale, weights and their iteration.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "irls.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace curvature_lines {

namespace {

// The three rows of X share one 2 x 2 normal matrix.
struct NormalEquations {
	double uu = 0.0, uv = 0.0, vv = 0.0;
	Eigen::Matrix<double, 2, 3> right = Eigen::Matrix<double, 2, 3>::Zero();
};

NormalEquations accumulate(const VariationSamples& s, const double* weights)
{
	double uu = 0, uv = 0, vv = 0, b[6] = {0, 0, 0, 0, 0, 0};
	for (std::size_t k = 0; k < s.pu.size(); ++k) {
		const double w = weights[k] * s.geometric[k];
		const double u = w * s.pu[k], v = w * s.pv[k];
		uu += u * s.pu[k];
		uv += u * s.pv[k];
		vv += v * s.pv[k];
		b[0] += u * s.nu[k];
		b[1] += u * s.nv[k];
		b[2] += u * s.nw[k];
		b[3] += v * s.nu[k];
		b[4] += v * s.nv[k];
		b[5] += v * s.nw[k];
	}
	NormalEquations equations;
	equations.uu = uu;
	equations.uv = uv;
	equations.vv = vv;
	equations.right << b[0], b[1], b[2], b[3], b[4], b[5];
	return equations;
}

} // namespace

void VariationSamples::clear()
{
	for (auto* column : {&pu, &pv, &nu, &nv, &nw, &geometric})
		column->clear();
	first.clear();
	second.clear();
}

void VariationSamples::add(
	Index                  a,
	Index                  b,
	const Eigen::Vector2d& dp,
	const Eigen::Vector3d& dn,
	double                 geometricWeight)
{
	first.push_back(a);
	second.push_back(b);
	pu.push_back(dp.x());
	pv.push_back(dp.y());
	nu.push_back(dn.x());
	nv.push_back(dn.y());
	nw.push_back(dn.z());
	geometric.push_back(geometricWeight);
}

bool VariationSamples::spanPlane() const
{
	double uu = 0.0, uv = 0.0, vv = 0.0;
	for (std::size_t k = 0; k < pu.size(); ++k) {
		uu += pu[k] * pu[k];
		uv += pu[k] * pv[k];
		vv += pv[k] * pv[k];
	}
	// det / trace bounds the smaller eigenvalue from below by half: a strip 1/1000 as wide as long is a line.
	return uu * vv - uv * uv > 1e-6 * (uu + vv) * (uu + vv);
}

VariationModel weightedLeastSquares(
	const VariationSamples& samples, const std::vector<double>& weights)
{
	const NormalEquations e     = accumulate(samples, weights.data());
	const double          trace = e.uu + e.vv;
	if (!(trace > 0.0))
		return VariationModel::Zero();
	const double    ridge = 1e-12 * trace;
	const double    uu = e.uu + ridge, vv = e.vv + ridge;
	Eigen::Matrix2d inverse;
	inverse << vv, -e.uv, -e.uv, uu;
	inverse /= uu * vv - e.uv * e.uv;
	return (inverse * e.right).transpose();
}

void IrlsSolver::computeResiduals(const VariationSamples& s, const VariationModel& model)
{
	const double uu = model(0, 0), uv = model(0, 1), vu = model(1, 0), vv = model(1, 1),
				 wu = model(2, 0), wv = model(2, 1);
	m_squared.resize(s.pu.size());
	for (std::size_t k = 0; k < s.pu.size(); ++k) {
		const double u = uu * s.pu[k] + uv * s.pv[k] - s.nu[k];
		const double v = vu * s.pu[k] + vv * s.pv[k] - s.nv[k];
		const double w = wu * s.pu[k] + wv * s.pv[k] - s.nw[k];
		m_squared[k]   = u * u + v * v + w * w;
	}
}

double IrlsSolver::scale(double factor, double quantile)
{
	m_scratch         = m_squared;
	const auto count  = static_cast<std::ptrdiff_t>(m_scratch.size());
	// The mean of the two middle residuals when their number is even.
	const double place = quantile * double(count - 1);
	const auto   low   = m_scratch.begin() + static_cast<std::ptrdiff_t>(std::floor(place));
	std::nth_element(m_scratch.begin(), low, m_scratch.end());
	double value = std::sqrt(*low);
	if (const double part = place - std::floor(place); part > 0.0)
		value += part * (std::sqrt(*std::min_element(low + 1, m_scratch.end())) - value);
	return std::max(factor * value, exactResidual);
}

void IrlsSolver::computeWeights(double sigma, const IrlsOptions& options)
{
	// w(t) = 2 / (1 + t^2)^2 for t = r / sigma < cut, else 0 (A09, Geman-McClure). Least squares gives
	// every sample the weight of a residual of 0.
	const double perSigma = options.robust ? 1.0 / (sigma * sigma) : 0.0;
	const double limit    = options.cut * options.cut;
	m_fit.weights.resize(m_squared.size());
	for (std::size_t k = 0; k < m_squared.size(); ++k) {
		const double t2  = m_squared[k] * perSigma;
		const double one = 1.0 + t2;
		m_fit.weights[k] = t2 < limit ? 2.0 / (one * one) : 0.0;
	}
}

const IrlsFit& IrlsSolver::fit(
	const VariationSamples& samples, const VariationModel& start, const IrlsOptions& options)
{
	m_fit.model      = start;
	m_fit.sigma      = exactResidual;
	m_fit.iterations = 0;
	m_fit.weights.clear();
	if (samples.size() == 0)
		return m_fit;

	bool moving = true;
	while (moving && m_fit.iterations < options.maxIterations) {
		// sigma comes from all samples every time and the cut is re-evaluated: a sample may return.
		computeResiduals(samples, m_fit.model);
		computeWeights(scale(options.sigmaFactor, options.quantile), options);
		const VariationModel next   = weightedLeastSquares(samples, m_fit.weights);
		const double         change = (next - m_fit.model).norm();
		moving      = options.robust && change > std::max(options.tolerance * next.norm(), exactResidual);
		m_fit.model = next;
		++m_fit.iterations;
	}
	computeResiduals(samples, m_fit.model);
	m_fit.sigma = scale(options.sigmaFactor, options.quantile);
	computeWeights(m_fit.sigma, options);
	return m_fit;
}

} // namespace curvature_lines
