// Principal curvatures at the scale the cloud itself asks for. Beyond the papers: their operating region is
// tied to the spacing (A09 section 3), so a denser cloud with the same noise gets a worse estimate.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "adaptive_scale.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "local_surface.h"
#include "progress.h"

namespace curvature_lines {

// The surface near every point: what curvature, normals and features are read from.
struct AdaptiveSurface {
	std::vector<SurfaceElement> elements; // N; invalid where nothing could be fitted
	Eigen::VectorXd             radius;   // N, of the largest ball used (length)
	// N, of the shape operator (squared Frobenius norm, 1/length^2)
	Eigen::VectorXd variance;
	Eigen::VectorXd feature; // N, strength of the sharp edge or corner nearby, 0..1
};

// Given normals tell the side of the surface only. Same result for any order of the points.
AdaptiveSurface adaptiveSurface(
	const CloudIndex&           index,
	const AdaptiveScaleOptions& options  = {},
	const Progress&             progress = {});

// The same as a curvature field. correctedNormals are the surface's normals, and the directions are
// tangent to them; to the cloud's normal where the two agree within a degree. The statistical weights are
// those of A09 section 4.1 point by point: Geman-McClure weights of what the neighbours' normals differ
// from the estimate's prediction.
CurvatureField adaptiveCurvature(
	const CloudIndex&           index,
	const AdaptiveScaleOptions& options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
