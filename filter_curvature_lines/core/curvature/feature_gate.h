// The gate before the all-pairs fit: which points of the region lie on p_i's own piece of the surface.
// A09 claims that weights vanish across sharp features; with all pairs alone they do not, because two
// points beyond a crease agree with each other. Internal to robust_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "irls.h"
#include "operating_region.h"
#include "point_cloud.h"

namespace curvature_lines {

// M-estimates from the pairs (p_i, p_j) alone, started flat, from the minimum neighbourhood, from the region.
struct CentreFits {
	std::array<VariationModel, 3> models;
	std::array<double, 3>         sigmas = {0.0, 0.0, 0.0};
	bool                          valid  = false; // enough points, not on a line
};

// The median over the cloud of the points' own sigma: makes the costs of different starts comparable.
double commonCentreScale(const std::vector<CentreFits>& fits);

struct GateResult {
	std::vector<Index> members;       // of the region, p_i first, then at least a handful
	double             consent = 0.0; // share of the region that agrees, 0..1
	// mean Geman-McClure cost of the centre pairs at the common scale
	double cost = 1.0;
};

// Holds the scratch of one thread.
class FeatureGate {
public:
	CentreFits fitCentre(
		const OperatingRegion& region,
		const VariationModel&  minimumNeighborhoodStart,
		const IrlsOptions&     options);

	// The points that agree with the best of the fits, or with a flat surface. Fits that turn the normal by more
	// than a right angle within the region are left out: the points beyond a crease project onto one line in the
	// tangent plane, and such a fit explains all of them as one steep surface.
	GateResult select(const OperatingRegion& region, const CentreFits& fits, double commonScale);

private:
	VariationSamples    m_samples;
	IrlsSolver          m_solver;
	std::vector<double> m_residuals, m_sorted, m_ones;
};

// How far the nearest neighbours agree with n_i. They support a normal when theirs are similar and they lie near
// its plane through p_i.
struct NormalConsensus {
	Eigen::Vector3d normal;           // the neighbour's normal with most support
	double          ownSupport = 0.0; // share of the neighbours that support n_i itself, 0..1
};
NormalConsensus normalConsensus(const OperatingRegion& region);

} // namespace curvature_lines
