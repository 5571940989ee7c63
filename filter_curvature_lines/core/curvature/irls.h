// Iteratively re-weighted least squares on pairs of normal variations (A09 section 3, eq. 1).
// Internal to robust_curvature; separate so that scale and weights can be tested exactly.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "robust_kernel.h"

namespace curvature_lines {

// Columns: the turn of the normal per unit of length along u and v; rows: its u, v, w components. The
// third row is 0 for infinitesimal steps and takes up the second-order turn of finite ones.
using VariationModel = Eigen::Matrix<double, 3, 2>;

// A pair of points a, b gives one sample: X * (dp.u, dp.v) = (dn.u, dn.v, dn.w) with dp = p_b - p_a,
// dn = n_b - n_a. Kept as one array per component, so that the passes over all samples vectorise.
struct VariationSamples {
	std::vector<double> pu, pv;        // dp
	std::vector<double> nu, nv, nw;    // dn, dimensionless
	std::vector<double> geometric;     // prior weight, 1 / mean squared distance to p_i
	std::vector<Index>  first, second; // the points a, b

	Index size() const { return static_cast<Index>(pu.size()); }
	void clear();
	void
	add(Index                  a,
	    Index                  b,
	    const Eigen::Vector2d& dp,
	    const Eigen::Vector3d& dn,
	    double                 geometricWeight);
	// True when the dp span the plane well enough to determine a model.
	bool spanPlane() const;
};

struct IrlsOptions {
	Index  maxIterations = 30;
	double tolerance     = 1e-4;
	double sigmaFactor   = deviationOverMedian;
	double cut           = 2.0;
	bool   robust        = true;
	// of the residuals, the median; less tolerates more than half outliers
	double quantile = 0.5;
};

// Residuals below this are exact: sigma and the change of the model stop mattering. Dimensionless, and
// the reason why the caller passes dp in units of the region's radius.
constexpr double exactResidual = 1e-6;

struct IrlsFit {
	VariationModel model = VariationModel::Zero();
	double         sigma = exactResidual; // sigmaFactor * quantile of the residuals at `model`
	// per sample at `model`, without the geometric weight; 0 if cut
	std::vector<double> weights;
	Index               iterations = 0;
};

// argmin sum_s weights_s geometric_s |X dp_s - dn_s|^2
VariationModel
weightedLeastSquares(const VariationSamples& samples, const std::vector<double>& weights);

// Holds the scratch of one thread.
class IrlsSolver {
public:
	// Minimises sum_s geometric_s rho(r_s / sigma) from `start`. The result lives until the next call.
	const IrlsFit&
	fit(const VariationSamples& samples, const VariationModel& start, const IrlsOptions& options);
	// The residuals of the last fit, squared.
	const std::vector<double>& squaredResiduals() const { return m_squared; }

private:
	void computeResiduals(const VariationSamples& samples, const VariationModel& model);
	double scale(const IrlsOptions& options, double& squaredQuantile);

	IrlsFit m_fit;
	// of the first residuals of the last fit, squared: a guess
	double              m_firstQuantile = 0.0;
	std::vector<double> m_squared, m_scratch;
};

} // namespace curvature_lines
