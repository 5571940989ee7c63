// The whole pipeline (A09 fig. 1): outliers out, positions denoised, curvature, directions, lines, mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "denoising.h"
#include "direction_smoothing.h"
#include "outlier_rejection.h"
#include "quad_mesh.h"

namespace curvature_lines {

struct ReconstructionOptions {
	bool rejectOutliers   = true;
	bool denoise          = true;
	bool smoothDirections = true;
	RobustCurvatureOptions    curvature;
	MinimumNeighborhoodOptions neighborhood;
	OutlierOptions            outliers;
	DenoisingOptions          denoising;
	DirectionSmoothingOptions directions;
	UmbilicOptions            umbilics;
	LineTracingOptions        tracing;   // targetVertices 0 and epsilon 0: from the size of the cloud
	QuadMeshOptions           mesh;
};

struct ReconstructionResult {
	std::vector<char> outlier;   // per input point
	std::vector<Index> kept;     // input index of each point of `cloud`
	PointCloud        cloud;     // cleaned
	CurvatureField    field;
	LineNetwork       lines;
	QuadMeshResult    mesh;
	std::map<std::string, double> seconds; // per stage: neighborhoods, outliers, normals, denoising, …
};

ReconstructionResult reconstruct(
	const PointCloud&            cloud, // prepared (unit frame)
	const ReconstructionOptions& options  = {},
	const Progress&              progress = {});

} // namespace curvature_lines
