// A curvature estimate as values of the raw points it was made from, in model units: what users and hosts get.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "curvature_field.h"
#include "point_cloud.h"

namespace curvature_lines {

// The normal of a raw point's kept point, as one for the raw point: of two sheets in the same place, each keeps its own
// side. A raw point's own normal may be wrong, so it does not tell the side of a kept point that is its own.
// `rawNormals` (3 x N): those the cloud was prepared from. The raw point must not be dropped.
Eigen::Vector3d normalForRaw(
	const Eigen::Vector3d&  normal,
	const Eigen::Matrix3Xd& rawNormals,
	const PreparedCloud&    prepared,
	Index                   raw);

// Of all raw points, those dropped included: they have zeros, arbitrary directions and status Invalid.
struct RawCurvatures {
	Eigen::VectorXd k1, k2, error, radius, confidence,
		feature; // N, as in CurvatureField, in model units
	// 3 x N unit, tangent to the raw normal where it agrees with the estimate's within a degree, else to the latter.
	Eigen::Matrix3Xd         d1, d2;
	std::vector<PointStatus> status; // N
};

// `umbilic`: per kept point; 1 makes status Ok to Umbilic. The field's directions are tangent to prepared.cloud.normals.
RawCurvatures rawCurvatures(
	const Eigen::Matrix3Xd&  rawNormals, // 3 x N, any length
	const PreparedCloud&     prepared,
	const CurvatureField&    field,
	const std::vector<char>& umbilic);

enum class CurvatureScalar { Mean, Gaussian, K1, K2, Curvedness, ShapeIndex, Confidence };

// N: one scalar of every raw point.
Eigen::VectorXd scalarsOf(const RawCurvatures& values, CurvatureScalar scalar);

// The range a ramp of colours should span: the 10th and 90th percentile of the values whose points have an estimate
// (status neither Invalid nor TooFewNeighbors); two zeros if there are none. Few points far off leave the ramp alone.
std::pair<double, double>
rampRange(const Eigen::VectorXd& values, const std::vector<PointStatus>& status);

} // namespace curvature_lines
