// From a cloud to a quad mesh in one step: the recipe of this project, and that of A09 fig. 1.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cloud_index.h"
#include "crease_curves.h"
#include "creases.h"
#include "curvature_estimate.h"
#include "curvature_field.h"
#include "denoising.h"
#include "direction_smoothing.h"
#include "line_network.h"
#include "line_tracing.h"
#include "mesh_finishing.h"
#include "mesh_quality.h"
#include "outlier_rejection.h"
#include "point_cloud.h"
#include "position_field_mesh.h"
#include "progress.h"
#include "scaffold.h"
#include "umbilics.h"

namespace curvature_lines {

struct ReconstructionOptions {
	// PositionField: the lines are where two phases on a triangulated scaffold are whole numbers. TracedLines:
	// as published.
	enum class Method { PositionField, TracedLines };
	Method                    method           = Method::PositionField;
	bool                      rejectOutliers   = true;
	bool                      denoise          = true;
	bool                      smoothDirections = true; // TracedLines
	CurvatureOptions          curvature;
	OutlierOptions            outliers;
	DenoisingOptions          denoising;
	DirectionSmoothingOptions directions;
	UmbilicOptions            umbilics;
	// targetVertices 0 and epsilon 0: from the size of the cloud; both methods
	LineTracingOptions tracing;
	CreaseOptions      creases; // PositionField
	// PositionField with tracing.targetVertices: denser clouds are thinned to so many points per vertex, but not
	// below 20 000 points, once the outliers are out. 0: all are used.
	double pointsPerVertex = 24.0;
	// PositionField: largest ratio of the line spacings in a place
	double anisotropy = 1.5;
	// PositionField: holes of the cloud this wide are closed, in its spacings
	double               holeSize = usualHoleSize;
	MeshFinishingOptions mesh;
	// PositionField: its lines as polylines; traced ones are always kept
	bool keepLines = false;

	ReconstructionOptions()
	{
		tracing.epsilon    = 0.0;
		tracing.stopFactor = meshStopFactor;
		tracing.gradation  = meshGradation;
		mesh.quads         = QuadKind::Pure;
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
	// Of the mesh, against `cloud`: what it does not show, and what is wrong with it
	MeshCoverage coverage;
	Index        foldedFaces = 0;
	// Larger than the cloud can carry was the number of vertices asked for, or that of the chord error: this many were aimed
	// at. 0: not so.
	Index boundedTarget = 0;
	// RobustDenoisingResult::pointDeviation; without denoising OutlierResult::heightDeviation; else 0
	double                        noise = 0.0;
	Eigen::VectorXd               moves; // per point of `cloud`, lengths: by denoising
	double                        rmsMove           = 0.0; // their root mean square
	double                        doubledShare      = 0.0; // RobustDenoisingResult::doubledShare
	double                        unstructuredShare = 0.0; // OutlierResult::unstructuredShare
	std::map<std::string, double> seconds; // per stage: outliers, neighborhoods, curvature, …
};

// Outliers out, dense clouds thinned, curvature of the noisy points, denoising, creases, and the mesh of a position
// field on the cleaned points. `given`: prepared (unit frame); let go as soon as it is not needed any more. The mesh
// may come out empty (too sparse a cloud); that is for the caller to report.
ReconstructionResult adaptiveRecipe(
	CloudIndex given, const ReconstructionOptions& options = {}, const Progress& progress = {});

// A09 fig. 1: outliers out, denoising, curvature of the denoised points, directions smoothed, lines traced, faces
// between their crossings. The stages' own options say whether each of them is the published one.
ReconstructionResult publishedRecipe(
	CloudIndex given, const ReconstructionOptions& options = {}, const Progress& progress = {});

// The one that options.method asks for.
ReconstructionResult reconstruct(
	CloudIndex given, const ReconstructionOptions& options = {}, const Progress& progress = {});

} // namespace curvature_lines
