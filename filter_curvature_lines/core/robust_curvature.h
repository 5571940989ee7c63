// Principal curvatures by M-estimation over all pairs of normal variations (A09 section 3, eq. 1;
// R07 section 3), with the gate that makes the published claim about sharp edges true.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "neighborhoods.h"

namespace curvature_lines {

// Conventions, everywhere in this project: outward normals; convex is positive (unit sphere:
// k1 = k2 = +1); k1 >= k2 by signed value; d1, d2, n orthonormal and right-handed up to the sign of d1.

struct RobustCurvatureOptions {
	double regionScale   = 3.0;  // operating region: ball of this many local spacings (A09 section 3)
	Index  maxIterations = 30;   // IRLS iterations per point
	double tolerance     = 1e-4; // stop when the tensor changes by less, relatively
	double sigmaFactor   = 1.4826; // sigma = factor * median residual (A09 eq. after 1)
	double cut           = 2.0;  // residuals above cut * sigma get weight 0
	// Keep only points that agree with p_i itself before forming pairs. Finds out as well when n_i is the
	// one that is wrong, and fits at the neighbours' normal instead; regions hold at least 20 points where
	// twice the radius does. false: the published algorithm.
	bool   featureGate   = true;
	bool   robust        = true; // false: plain distance-weighted least squares (for comparison)
	Index  maxPoints     = 120;  // cap of the operating region
	Index  maxPairs      = 2000; // above, a deterministic subsample of the pairs
};

// Row i: the points p_j that take part in the final fit at p_i, with W_i[j] > 0 (A09 section 4.1):
// the sum of Geman-McClure weights of p_j's pairs, divided by twice the number of its pairs, in (0, 1].
struct StatisticalWeights {
	NeighborLists       neighbors; // sorted by index in each row; never contains i itself
	std::vector<double> values;    // parallel to neighbors.indices

	// W_i[j], 0 when absent.
	double operator()(Index i, Index j) const;
};

struct CurvatureField {
	Eigen::VectorXd  k1, k2;      // N, 1/length, k1 >= k2
	Eigen::Matrix3Xd d1, d2;      // 3 x N, unit, tangent at cloud.normals
	Eigen::VectorXd  error;       // N, standard error of k1 - k2 (1/length)
	Eigen::VectorXd  radius;      // N, radius of the operating region (length)
	Eigen::VectorXd  confidence;  // N, C_j = sum_i W_i[j] (A09 section 5.1)
	Eigen::VectorXd  feature;     // N, strength of the sharp edge or corner nearby, 0..1
	std::vector<PointStatus> status;
	StatisticalWeights       weights;
	// The affine model's normal at p_i: unit(sum_j W_j (n_j - X d_j)) (A09 end of section 3; R07).
	// Kept beside the input normals; the caller decides whether to adopt it. Replaces wrong input normals.
	Eigen::Matrix3Xd correctedNormals; // 3 x N unit
	// N, height of the surface fitted around p_i above it, along correctedNormals (length): far less noisy than
	// the point. Empty where none was fitted, or after the points moved.
	Eigen::VectorXd  height;
	Index iterations = 0;              // largest number of IRLS iterations any point needed

	Index size() const { return static_cast<Index>(k1.size()); }
};

CurvatureField robustCurvature(
	const PointCloud&             cloud,
	const NeighborSearch&         search,
	const MinimumNeighborhoods&   minimum,
	const RobustCurvatureOptions& options  = {},
	const Progress&               progress = {});

// Rows of statistical weights built in parallel, and the confidence they add up to,
// C_j = sum_i W_i[j] (A09 section 5.1), into a field whose confidence is 0.
void adoptWeights(
	const std::vector<std::vector<Index>>&  rows,
	const std::vector<std::vector<double>>& weights,
	CurvatureField&                         field);

// Geman-McClure cost and weight of a normalised residual t = r / sigma (A09 fig. 5b, c).
double gemanMcClureCost(double t);
double gemanMcClureWeight(double t);

// The scalars users ask for by name. Zero-safe: plane gives 0 everywhere.
double shapeIndex(double k1, double k2);  // Koenderink: (2/pi) atan2(k1 + k2, k1 - k2), +1 convex cap, 0 saddle
double curvedness(double k1, double k2);  // sqrt((k1^2 + k2^2) / 2)

} // namespace curvature_lines
