// M-estimation of the variation model (A09 section 3, eq. 1): scale, weights and their iteration.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "irls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "bracketed_selection.h"
#include "point_cloud.h"
#include "robust_kernel.h"

namespace curvature_lines {

namespace {

// Anderson's acceleration with one step of memory: re-weighting converges linearly, and where the model goes
// shows in how the last step differs from this one. The fixed point stays the same. No farther than another
// step: up to twice the step the quadratic that the weights stand for still falls along it.
VariationModel
furtherOn(const VariationModel& advance, const VariationModel& step, const VariationModel& lastStep)
{
	const VariationModel change  = step - lastStep;
	const double         squared = change.squaredNorm();
	if (!(squared > 0.0))
		return VariationModel::Zero();
	const VariationModel further = -(change.cwiseProduct(step).sum() / squared) * advance;
	const double         length = further.norm(), limit = step.norm();
	return length > limit ? VariationModel(further * (limit / length)) : further;
}

// argmin_X sum_s w_s geometric_s |X dp_s - dn_s|^2, w_s = weightOf(s) asked in one pass over the samples.
template<class WeightOf>
VariationModel solveWeighted(const VariationSamples& samples, const WeightOf& weightOf)
{
	const double *pu = samples.pu.data(), *pv = samples.pv.data(), *nu = samples.nu.data(),
				 *nv = samples.nv.data(), *nw = samples.nw.data(),
				 *geometric = samples.geometric.data();
	// The three rows of X share one 2 x 2 normal matrix.
	double      uu = 0.0, uv = 0.0, vv = 0.0;
	double      uOfU = 0.0, vOfU = 0.0, uOfV = 0.0, vOfV = 0.0, uOfW = 0.0, vOfW = 0.0;
	const Index count = samples.size();
#pragma omp simd reduction(+ : uu, uv, vv, uOfU, vOfU, uOfV, vOfV, uOfW, vOfW)
	for (Index s = 0; s < count; ++s) {
		const double w = weightOf(s) * geometric[s];
		const double u = w * pu[s], v = w * pv[s];
		uu += u * pu[s];
		uv += u * pv[s];
		vv += v * pv[s];
		uOfU += u * nu[s];
		vOfU += v * nu[s];
		uOfV += u * nv[s];
		vOfV += v * nv[s];
		uOfW += u * nw[s];
		vOfW += v * nw[s];
	}
	const double trace = uu + vv;
	if (!(trace > 0.0))
		return VariationModel::Zero();
	uu += 1e-12 * trace;
	vv += 1e-12 * trace;
	const double   perDeterminant = 1.0 / (uu * vv - uv * uv);
	VariationModel model;
	const auto     solveRow = [&](int row, double u, double v) {
        model(row, 0) = (vv * u - uv * v) * perDeterminant;
        model(row, 1) = (uu * v - uv * u) * perDeterminant;
	};
	solveRow(0, uOfU, vOfU);
	solveRow(1, uOfV, vOfV);
	solveRow(2, uOfW, vOfW);
	return model;
}

// w(t) = 2 / (1 + t^2)^2 for t = r / sigma < cut, else 0 (A09, Geman-McClure). Least squares gives every
// sample the weight of a residual of 0.
struct GemanMcClure {
	double perSquaredSigma, limit;

	GemanMcClure(double sigma, const IrlsOptions& options) :
			perSquaredSigma(options.robust ? 1.0 / (sigma * sigma) : 0.0),
			limit(options.cut * options.cut)
	{
	}
	double operator()(double squaredResidual) const
	{
		const double t2     = squaredResidual * perSquaredSigma;
		const double weight = 2.0 / gemanMcClureDivisor(t2);
		return t2 < limit ? weight : 0.0;
	}
};

} // namespace

void VariationSamples::clear()
{
	for (auto* column : {&pu, &pv, &nu, &nv, &nw, &geometric})
		column->clear();
	first.clear();
	second.clear();
}

void VariationSamples::add(
	Index a, Index b, const Eigen::Vector2d& dp, const Eigen::Vector3d& dn, double geometricWeight)
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

VariationModel
weightedLeastSquares(const VariationSamples& samples, const std::vector<double>& weights)
{
	const double* values = weights.data();
	return solveWeighted(samples, [=](Index s) { return values[s]; });
}

void IrlsSolver::computeResiduals(const VariationSamples& samples, const VariationModel& model)
{
	const double uu = model(0, 0), uv = model(0, 1), vu = model(1, 0), vv = model(1, 1),
				 wu = model(2, 0), wv = model(2, 1);
	const double *pu = samples.pu.data(), *pv = samples.pv.data(), *nu = samples.nu.data(),
				 *nv = samples.nv.data(), *nw = samples.nw.data();
	const Index count = samples.size();
	m_squared.resize(count);
	double* squared = m_squared.data();
#pragma omp simd
	for (Index s = 0; s < count; ++s) {
		const double u = uu * pu[s] + uv * pv[s] - nu[s];
		const double v = vu * pu[s] + vv * pv[s] - nv[s];
		const double w = wu * pu[s] + wv * pv[s] - nw[s];
		squared[s]     = u * u + v * v + w * w;
	}
}

// Residuals change little from one iteration to the next, and from one point to the next.
double IrlsSolver::scale(const IrlsOptions& options, double& squaredQuantile)
{
	const int      count   = static_cast<int>(m_squared.size());
	const double   place   = options.quantile * double(count - 1);
	const double*  squared = m_squared.data();
	const Selected middle  = selectNear(
        squaredQuantile,
        count,
        [=](int s) { return squared[s]; },
        [=](std::size_t counted) { return std::min(static_cast<std::size_t>(place), counted - 1); },
        m_scratch);
	squaredQuantile = middle.value;
	double value    = std::sqrt(std::max(middle.value, 0.0));
	// The mean of the two middle residuals when their number is even.
	if (const double part = place - std::floor(place); part > 0.0)
		value += part * (std::sqrt(std::max(middle.next, 0.0)) - value);
	return std::max(options.sigmaFactor * value, exactResidual);
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

	VariationModel lastNext = VariationModel::Zero(), lastStep = lastNext;
	bool           moving   = true;
	double         quantile = m_firstQuantile;
	while (moving && m_fit.iterations < options.maxIterations) {
		// sigma comes from all samples every time and the cut is re-evaluated: a sample may return.
		computeResiduals(samples, m_fit.model);
		const GemanMcClure weightOf(scale(options, quantile), options);
		if (m_fit.iterations == 0)
			m_firstQuantile = quantile;
		const double*        squared = m_squared.data();
		const VariationModel next =
			solveWeighted(samples, [=](Index s) { return weightOf(squared[s]); });
		const VariationModel step   = next - m_fit.model;
		const double         change = step.norm();
		moving =
			options.robust && change > std::max(options.tolerance * next.norm(), exactResidual);

		m_fit.model = next;
		if (moving && m_fit.iterations > 0)
			m_fit.model += furtherOn(next - lastNext, step, lastStep);
		lastNext = next;
		lastStep = step;
		++m_fit.iterations;
	}
	computeResiduals(samples, m_fit.model);
	m_fit.sigma = scale(options, quantile);
	const GemanMcClure weightOf(m_fit.sigma, options);
	m_fit.weights.resize(m_squared.size());
	std::transform(m_squared.begin(), m_squared.end(), m_fit.weights.begin(), weightOf);
	return m_fit;
}

} // namespace curvature_lines
