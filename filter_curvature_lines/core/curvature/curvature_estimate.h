// Principal curvatures of a cloud, at the scale the cloud asks for or at the published one (A09 section 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "adaptive_scale.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "progress.h"
#include "robust_curvature.h"

namespace curvature_lines {

enum class ScaleMode {
	Adaptive, // found from the cloud, around every point
	Paper     // A09: a fixed number of local spacings
};

struct CurvatureOptions {
	ScaleMode              scaleMode = ScaleMode::Adaptive;
	AdaptiveScaleOptions   adaptive;
	RobustCurvatureOptions paper;
};

// Whether both ask for the same estimate: options of the mode that is not chosen do not count.
bool operator==(const CurvatureOptions& a, const CurvatureOptions& b);

// Directions are tangent to the cloud's normals with Paper. With Adaptive they are tangent to the fitted
// surface, see surfaceNormals().
CurvatureField estimateCurvature(
	const CloudIndex& index, const CurvatureOptions& options = {}, const Progress& progress = {});

// 3 x N unit: the normals the directions of a field are tangent to, n = d1 x d2.
Eigen::Matrix3Xd surfaceNormals(const CurvatureField& field);

// Turns the directions into the tangent planes of `normals` (3 x N unit), as little as possible.
void makeTangent(const Eigen::Matrix3Xd& normals, CurvatureField& field);

// Replaces d1 by `directions` (3 x N, any length) where they are usable (finite and longer than 1e-6), and d2 with it,
// both tangent to `normals` (3 x N unit).
void adoptDirections(
	const Eigen::Matrix3Xd& directions, const Eigen::Matrix3Xd& normals, CurvatureField& field);

} // namespace curvature_lines
