// M-estimation of the variation model (A09 section 3, eq. 1): scale, weights and their iteration.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "irls.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace curvature_lines {

namespace {

using Column = Eigen::Map<const Eigen::ArrayXd>;

Column column(const std::vector<double>& values)
{
	return Column(values.data(), static_cast<Eigen::Index>(values.size()));
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
	// The three rows of X share one 2 x 2 normal matrix.
	const Column         pu = column(samples.pu), pv = column(samples.pv);
	const Eigen::ArrayXd w  = column(weights) * column(samples.geometric);
	const Eigen::ArrayXd u = w * pu, v = w * pv;
	double               uu = (u * pu).sum(), vv = (v * pv).sum();
	const double         uv    = (u * pv).sum();
	const double         trace = uu + vv;
	if (!(trace > 0.0))
		return VariationModel::Zero();
	uu += 1e-12 * trace;
	vv += 1e-12 * trace;
	const double   perDeterminant = 1.0 / (uu * vv - uv * uv);
	VariationModel model;
	const auto     solveRow = [&](int row, const Column& dn) {
        const double bu = (u * dn).sum(), bv = (v * dn).sum();
        model(row, 0)   = (vv * bu - uv * bv) * perDeterminant;
        model(row, 1)   = (uu * bv - uv * bu) * perDeterminant;
	};
	solveRow(0, column(samples.nu));
	solveRow(1, column(samples.nv));
	solveRow(2, column(samples.nw));
	return model;
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

// Residuals change little from one iteration to the next, so the quantile is first looked for around the
// last one: a pass over all and a selection among few.
double IrlsSolver::scale(const IrlsOptions& options)
{
	const std::size_t count = m_squared.size();
	const double      place = options.quantile * double(count - 1);
	const auto        rank  = static_cast<std::size_t>(place);
	std::size_t       below = 0, inside = 0;
	m_scratch.resize(count);
	const double low = m_lastQuantile * (1.0 / 1.5), high = m_lastQuantile * 1.5;
	for (const double r : m_squared) {
		below += r < low;
		m_scratch[inside] = r;
		inside += (r >= low) & (r < high);
	}
	if (rank < below || rank + 1 >= below + inside) {
		m_scratch = m_squared;
		below     = 0;
		inside    = count;
	}
	const auto at  = m_scratch.begin() + (rank - below);
	const auto end = m_scratch.begin() + inside;
	std::nth_element(m_scratch.begin(), at, end);
	m_lastQuantile = *at;
	double value   = std::sqrt(*at);
	// The mean of the two middle residuals when their number is even.
	if (const double part = place - double(rank); part > 0.0)
		value += part * (std::sqrt(*std::min_element(at + 1, end)) - value);
	return std::max(options.sigmaFactor * value, exactResidual);
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
	m_lastQuantile = 0.0;
	if (samples.size() == 0)
		return m_fit;

	bool moving = true;
	while (moving && m_fit.iterations < options.maxIterations) {
		// sigma comes from all samples every time and the cut is re-evaluated: a sample may return.
		computeResiduals(samples, m_fit.model);
		computeWeights(scale(options), options);
		const VariationModel next   = weightedLeastSquares(samples, m_fit.weights);
		const double         change = (next - m_fit.model).norm();
		moving      = options.robust && change > std::max(options.tolerance * next.norm(), exactResidual);
		m_fit.model = next;
		++m_fit.iterations;
	}
	computeResiduals(samples, m_fit.model);
	m_fit.sigma = scale(options);
	computeWeights(m_fit.sigma, options);
	return m_fit;
}

} // namespace curvature_lines
