// Normals for clouds that come without: plane fits (Hoppe 1992, A09 ref. 17) oriented by a minimum
// spanning tree (CGAL).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

struct NormalEstimationOptions {
	Index neighbors = 25;   // points per plane fit; 15 keeps edges, 50 resists noise
	bool  orient    = true; // propagate one orientation, outward for closed shapes
};

// positions: 3 x N finite. Returns 3 x N unit normals. Throws InputError for fewer than 3 points.
Eigen::Matrix3Xd estimateNormals(
	const Eigen::Matrix3Xd&        positions,
	const NormalEstimationOptions& options  = {},
	const Progress&                progress = {});

// When normals that come with a cloud are replaced by estimated ones.
enum class EstimateNormals {
	IfMissing, // when fewer than half of them are usable: finite and not zero
	Never,
	Always
};

bool mustEstimate(EstimateNormals when, const Eigen::Matrix3Xd& normals); // 3 x N, any length

// estimateNormals() for clouds with points whose positions (3 x N) are not finite: these keep theirs of `normals`.
Eigen::Matrix3Xd estimateNormalsWhereFinite(
	const Eigen::Matrix3Xd&        positions,
	Eigen::Matrix3Xd               normals,
	const NormalEstimationOptions& options  = {},
	const Progress&                progress = {});

} // namespace curvature_lines
