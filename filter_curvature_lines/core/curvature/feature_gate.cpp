// Selects the points that agree with p_i itself, before pairs are formed between them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "feature_gate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "irls.h"
#include "neighborhoods.h"
#include "operating_region.h"
#include "point_cloud.h"
#include "robust_kernel.h"

namespace curvature_lines {

namespace {

// By experiment on tori and cubes (benchmarks/paper_figures.py and accuracy.py, tests of robust_curvature). Beyond A09.
constexpr Index minMembers = 5; // besides p_i: enough pairs for a model
// Sigmas: points farther from the model lie on another piece of the surface.
constexpr double gateFactor = 2.5;
// A point's own sigma counts within these multiples of the common one: a smaller one would leave out points for plain
// noise, a larger one is that of a crease.
constexpr double minScale = 2.0;
constexpr double maxScale = 3.0;
// Norm of a model, per radius of the region: a larger one explains points beyond a crease as one steep surface.
constexpr double maxTurn = 2.0;
// Radians: exact normals still turn by the change of the curvature itself.
constexpr double minCommonScale = 1e-3;
// p_i's side may hold less than half of the region at a crease, a third at a corner.
constexpr double creaseQuantile = 0.3;
constexpr Index  consenting     = 20;  // neighbours whose normals are compared with n_i
constexpr double consentAngle   = 0.5; // radians between normals that agree

double residual(const OperatingRegion& region, const VariationModel& model, Index j)
{
	return (model * region.positions[j] - (region.normals[j] - region.normals[0])).norm();
}

double meanCost(const OperatingRegion& region, const VariationModel& model, double scale)
{
	double cost = 0.0, total = 0.0;
	for (Index j = 1; j < region.size(); ++j) {
		// No nearer than a spacing: one neighbour must not decide between two models.
		const double weight =
			1.0 / std::max(region.squaredDistances[j], region.spacing * region.spacing);
		cost += weight * gemanMcClureCost(residual(region, model, j) / scale);
		total += weight;
	}
	return cost / total;
}

} // namespace

double commonCentreScale(const std::vector<CentreFits>& fits)
{
	std::vector<double> sigmas;
	for (const CentreFits& f : fits)
		if (f.valid)
			// [0] is no median, see fitCentre()
			sigmas.push_back(std::min(f.sigmas[1], f.sigmas[2]));
	if (sigmas.empty())
		return minCommonScale;
	const auto middle = sigmas.begin() + sigmas.size() / 2;
	std::nth_element(sigmas.begin(), middle, sigmas.end());
	return std::max(*middle, minCommonScale);
}

CentreFits FeatureGate::fitCentre(
	const OperatingRegion& region,
	const VariationModel&  minimumNeighborhoodStart,
	const IrlsOptions&     options)
{
	CentreFits result;
	collectCentrePairs(region, m_samples);
	result.valid = m_samples.size() >= minMembers && m_samples.spanPlane();
	if (!result.valid)
		return result;

	m_ones.assign(m_samples.size(), 1.0);
	const std::array<VariationModel, 3> starts = {
		VariationModel::Zero(), minimumNeighborhoodStart, weightedLeastSquares(m_samples, m_ones)};
	for (std::size_t s = 0; s < starts.size(); ++s) {
		IrlsOptions tolerant = options;
		tolerant.quantile    = s == 0 ? creaseQuantile : 0.5;
		const IrlsFit& fit   = m_solver.fit(m_samples, starts[s], tolerant);
		result.models[s]     = fit.model;
		result.sigmas[s]     = fit.sigma;
	}
	return result;
}

GateResult
FeatureGate::select(const OperatingRegion& region, const CentreFits& fits, double commonScale)
{
	GateResult result;
	if (!fits.valid) {
		result.members.resize(region.size());
		std::iota(result.members.begin(), result.members.end(), 0);
		return result;
	}
	VariationModel best  = VariationModel::Zero();
	double         sigma = 0.0;
	result.cost          = meanCost(region, best, commonScale);
	for (std::size_t s = 0; s < fits.models.size(); ++s) {
		const double cost = meanCost(region, fits.models[s], commonScale);
		if (cost < result.cost && fits.models[s].norm() < maxTurn) {
			result.cost = cost;
			best        = fits.models[s];
			sigma       = fits.sigmas[s];
		}
	}
	const double limit =
		gateFactor * std::clamp(sigma, minScale * commonScale, maxScale * commonScale);

	m_residuals.assign(1, 0.0);
	for (Index j = 1; j < region.size(); ++j)
		m_residuals.push_back(residual(region, best, j));
	m_sorted            = m_residuals;
	const Index atLeast = std::min<Index>(minMembers, region.size() - 1);
	std::nth_element(m_sorted.begin(), m_sorted.begin() + atLeast, m_sorted.end());
	const double widened = std::max(limit, m_sorted[atLeast]);

	Index agreeing = 0;
	for (Index j = 0; j < region.size(); ++j) {
		agreeing += j > 0 && m_residuals[j] <= limit;
		if (m_residuals[j] <= widened)
			result.members.push_back(j);
	}
	result.consent = double(agreeing) / double(region.size() - 1);
	return result;
}

NormalConsensus normalConsensus(const OperatingRegion& region)
{
	const Index     last = std::min<Index>(region.size() - 1, consenting);
	NormalConsensus result;
	Index           best     = 0;
	double          bestCost = std::numeric_limits<double>::infinity();
	for (Index a = 0; a <= last; ++a) {
		const Eigen::Vector3d& normal  = region.normals[a];
		double                 cost    = 0.0;
		Index                  support = 0;
		for (Index b = 1; b <= last; ++b) {
			const double turn = (normal - region.normals[b]).norm();
			const double rise =
				region.positions[b].dot(normal.head<2>()) + region.heights[b] * normal.z();
			const double distance =
				std::max(std::sqrt(region.squaredDistances[b]), 0.1 * region.spacing);
			const double angle = turn + std::abs(rise) / distance;
			cost += gemanMcClureCost(angle / consentAngle); // other wrong normals must not pull
			support += angle < consentAngle;
		}
		if (a == 0)
			result.ownSupport = double(support) / std::max<double>(last, 1.0);
		else if (cost < bestCost) {
			bestCost = cost;
			best     = a;
		}
	}
	const TangentFrame&    frame  = region.frame;
	const Eigen::Vector3d& normal = region.normals[best];
	result.normal =
		(normal.x() * frame.u + normal.y() * frame.v + normal.z() * frame.n).normalized();
	return result;
}

} // namespace curvature_lines
