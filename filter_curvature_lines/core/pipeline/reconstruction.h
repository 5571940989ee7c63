// The whole pipeline (A09 fig. 1): outliers out, points denoised, curvature, directions, lines, mesh.
// A09 estimates curvature first; robust outlier rejection and denoising need none, so that it is estimated
// once. The stages share their engine (local_polynomial.h, surface_patch.h) and the order of the points
// (shuffled_order.h), but neither search trees nor noise: every stage sees other positions, and what large
// voters miss, detail included, is no measure of what small patches call noise.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "creases.h"
#include "curvature_estimate.h"
#include "denoising.h"
#include "direction_smoothing.h"
#include "line_network.h"
#include "line_tracing.h"
#include "mesh_finishing.h"
#include "outlier_rejection.h"
#include "position_field_mesh.h"
#include "umbilics.h"

namespace curvature_lines {

struct ReconstructionOptions {
	// PositionField: the lines are where two phases on a triangulated scaffold are whole numbers. TracedLines:
	// as published.
	enum class Method { PositionField, TracedLines };
	Method                     method           = Method::PositionField;
	bool                       rejectOutliers   = true;
	bool                       denoise          = true;
	bool                       smoothDirections = true;
	CurvatureOptions           curvature;
	MinimumNeighborhoodOptions neighborhood;
	OutlierOptions             outliers;
	DenoisingOptions           denoising;
	DirectionSmoothingOptions  directions;
	UmbilicOptions             umbilics;
	// targetVertices 0 and epsilon 0: from the size of the cloud; both methods
	LineTracingOptions tracing;
	CreaseOptions      creases; // PositionField
	// PositionField with tracing.targetVertices: denser clouds are thinned to so many points per vertex, but not
	// below 20 000 points, once the outliers are out. 0: all are used.
	double pointsPerVertex = 24.0;
	// PositionField: largest ratio of the line spacings in a place
	double               anisotropy = 1.5;
	MeshFinishingOptions mesh;
	// PositionField: its lines as polylines; traced ones are always kept
	bool keepLines = false;

	ReconstructionOptions()
	{
		tracing.epsilon    = 0.0;
		tracing.stopFactor = meshStopFactor;
		tracing.gradation  = meshGradation;
	}
};

struct ReconstructionResult {
	std::vector<char> outlier; // per input point
	// input index of each point of `cloud`: no outliers, a sample of dense clouds
	std::vector<Index>      kept;
	PointCloud              cloud; // cleaned; with the estimate's normals unless scaleMode is Paper
	CurvatureField          field; // of the cleaned cloud, directions as the lines followed them
	UmbilicRegions          umbilics;
	LineNetwork             lines;   // TracedLines, or if keepLines
	Creases                 creases; // PositionField
	PositionFieldMeshResult mesh;    // TracedLines: without what is particular to position fields
	// RobustDenoisingResult::pointDeviation; without denoising OutlierResult::heightDeviation; else 0
	double                        noise   = 0.0;
	double                        rmsMove = 0.0; // by denoising
	std::map<std::string, double> seconds;       // per stage: outliers, neighborhoods, curvature, …
};

// The mesh may come out empty (too sparse a cloud); that is for the caller to report.
ReconstructionResult reconstruct(
	const PointCloud&            cloud, // prepared (unit frame)
	const ReconstructionOptions& options  = {},
	const Progress&              progress = {});

// How many vertices a mesh of a cloud of n points gets when nobody says: one per 16 points, faces about
// four point spacings wide; small clouds, which show little in so few, up to one per 4 points.
Index automaticTargetVertices(Index n);

} // namespace curvature_lines
