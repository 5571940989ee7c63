// Normals for clouds that come without: plane fits (Hoppe 1992, A09 ref. 17), their sides by winding numbers (Lin et al.
// 2024).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// What decides the side of open pieces, for which winding numbers decide nothing.
enum class OpenSides { Any, Viewpoint, Up };

struct NormalEstimationOptions {
	Index     neighbors = 0; // points per plane fit; 0: 25, and more as far as the cloud is noisy
	OpenSides openSides = OpenSides::Any;
	Eigen::Vector3d viewpoint =
		Eigen::Vector3d::Zero(); // OpenSides::Viewpoint; units of the positions
};

struct EstimatedNormals {
	Eigen::Matrix3Xd normals;    // 3 x N, unit
	Eigen::VectorXd  doubt;      // N, 0: the neighbours agree on the side .. 1: they do not
	double doubtfulShare  = 0.0; // of points with a doubt over 0.4; right per cloud, not per point
	double undecidedShare = 0.0; // of points on open pieces: consistent, but either side is right
};

// positions: 3 x N finite. Throws InputError for fewer than 3 points. Does not depend on the order of the points.
EstimatedNormals estimateNormals(
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

// The distinct finite points of a raw cloud (3 x N), all with one normal. Throws InputError as prepareCloud() does.
PreparedCloud withoutNormals(const Eigen::Matrix3Xd& positions);

// estimateNormals() of the points prepared.cloud holds (its normals have no say) for all N raw ones: duplicates share what
// their kept point gets, points that are not finite keep theirs of `normals` (3 x N). Options in model units.
EstimatedNormals estimateNormalsOfAll(
	const PreparedCloud&    prepared,
	Eigen::Matrix3Xd        normals,
	NormalEstimationOptions options  = {},
	const Progress&         progress = {});

} // namespace curvature_lines
