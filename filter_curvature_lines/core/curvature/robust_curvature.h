// Principal curvatures by M-estimation over all pairs of normal variations (A09 section 3, eq. 1;
// R07 section 3), with the gate that makes the published claim about sharp edges true.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "curvature_field.h"
#include "members.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_kernel.h"

namespace curvature_lines {

struct RobustCurvatureOptions {
	// operating region: ball of this many local spacings (A09 section 3)
	double regionScale   = 3.0;
	Index  maxIterations = 30;                // IRLS iterations per point
	double tolerance     = 1e-4;              // stop when the tensor changes by less, relatively
	double sigmaFactor = deviationOverMedian; // sigma = factor * median residual (A09 eq. after 1)
	double cut         = 2.0;                 // residuals above cut * sigma get weight 0
	// Keep only points that agree with p_i itself before forming pairs. Finds out as well when n_i is the
	// one that is wrong, and fits at the neighbours' normal instead; regions hold at least 20 points where
	// twice the radius does. false: the published algorithm.
	bool  featureGate = true;
	bool  robust      = true; // false: plain distance-weighted least squares (for comparison)
	Index maxPoints   = 120;  // cap of the operating region
	Index maxPairs    = 2000; // above, a deterministic subsample of the pairs
};

inline bool operator==(const RobustCurvatureOptions& a, const RobustCurvatureOptions& b)
{
	return members<9>(a) == members<9>(b);
}

CurvatureField robustCurvature(
	const CloudIndex&             index,
	const RobustCurvatureOptions& options  = {},
	const Progress&               progress = {});

} // namespace curvature_lines
