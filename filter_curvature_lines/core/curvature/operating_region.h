// The operating region of a point and its samples of normal variation (A09 section 3, fig. 4b).
// Internal to robust_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "irls.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

// The ball around p_i seen in a tangent frame there, lengths in units of its radius. Point 0 is p_i.
struct OperatingRegion {
	std::vector<Index>           points;
	std::vector<Eigen::Vector2d> positions;        // along u, v, relative to p_i
	std::vector<Eigen::Vector3d> normals;          // along u, v, n
	std::vector<double>          heights;          // along n, relative to p_i
	std::vector<double>          squaredDistances; // to p_i, in space
	TangentFrame                 frame   = TangentFrame(Eigen::Vector3d::UnitZ());
	double                       radius  = 1.0; // length
	double                       spacing = 1.0; // local spacing, in radii

	Index size() const { return static_cast<Index>(points.size()); }

	// `normal` stands for n_i, which may be wrong. Then so may be the spacing, which is measured in its
	// tangent plane: with fewer than minPoints the ball grows, to twice its radius at most.
	void collect(
		const PointCloud&      cloud,
		const NeighborSearch&  search,
		Index                  i,
		const Eigen::Vector3d& normal,
		double                 localSpacing,
		double                 regionScale,
		Index                  minPoints,
		Index                  maxPoints);

	// 1 / mean squared distance of the two points to p_i, A09's prior for the variance of a sample.
	double geometricWeight(Index a, Index b) const;
};

void collectCentrePairs(const OperatingRegion& region, VariationSamples& samples);
// All pairs of the members (indices into the region), or a fixed subsample of about maxPairs of them.
void collectPairs(
	const OperatingRegion&    region,
	const std::vector<Index>& members,
	Index                     maxPairs,
	VariationSamples&         samples);

} // namespace curvature_lines
