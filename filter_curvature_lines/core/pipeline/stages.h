// The stages that the recipes, and the filter that traces lines, are made of: each takes the value of the one before
// and gives its own.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
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
#include "outlier_rejection.h"
#include "point_cloud.h"
#include "position_field_mesh.h"
#include "progress.h"
#include "scaffold.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

// Seconds per stage: outliers, neighborhoods, curvature, …
class StageClock {
public:
	// Books the time since the last call to a stage; stages that run twice add up.
	void book(const char* stage);
	const std::map<std::string, double>& seconds() const { return m_seconds; }

private:
	using Clock = std::chrono::steady_clock;
	std::map<std::string, double> m_seconds;
	Clock::time_point             m_last = Clock::now();
};

// The points of a cloud that are left when its outliers are out, still with their noise.
struct NoisyPoints {
	CloudIndex         index;
	std::vector<Index> kept;                    // index in the given cloud of each
	std::vector<char>  outlier;                 // of each point of the given cloud
	double             heightDeviation   = 0.0; // OutlierResult::heightDeviation; 0: not measured
	double             unstructuredShare = 0.0; // OutlierResult::unstructuredShare
};

NoisyPoints allPoints(const CloudIndex& given);

// Throws InputError when hardly a point is left.
NoisyPoints
withoutOutliers(const CloudIndex& given, const OutlierOptions& options, const Progress& progress);

// A sample of about `most` points, where there are more: what a mesh of few vertices has no use for.
NoisyPoints thinned(NoisyPoints points, double most, const Progress& progress);

struct CleaningOptions {
	bool             denoise = true;
	CurvatureOptions curvature;
	DenoisingOptions denoising;
};

// The points as lines and faces are to see them, with the curvature there. Directions are tangent to the normals of
// `index`, which are those of the estimate unless it was made with ScaleMode::Paper.
struct CleanSurface {
	CloudIndex     index;
	CurvatureField field;
	// RobustDenoisingResult::pointDeviation; without denoising OutlierResult::heightDeviation; else 0
	double noise = 0.0;
	// N, lengths: how far denoising moved each point, 0 without; and their root mean square
	Eigen::VectorXd moves;
	double          rmsMove      = 0.0;
	double          doubledShare = 0.0; // RobustDenoisingResult::doubledShare; 0 without
};

// Curvature from the noisy points, then denoising. Denoised points lie on a smooth surface of its own small waves,
// which an estimate on them follows and cannot tell from shape: with directions from the noisy points a mesh is two
// to four times better aligned. For ScaleMode::Adaptive and DenoisingOptions::Method::Robust.
CleanSurface estimateThenDenoise(
	const NoisyPoints&     noisy,
	const CleaningOptions& options,
	StageClock&            clock,
	const Progress&        progress);

// The published order (A09 fig. 1): denoising, then curvature from the denoised points.
CleanSurface denoiseThenEstimate(
	const NoisyPoints&     noisy,
	const CleaningOptions& options,
	StageClock&            clock,
	const Progress&        progress);

// The cloud with the normals of an adaptive estimate of its points, and the directions in their tangent planes.
CleanSurface adoptEstimate(const CloudIndex& index, CurvatureField field);

struct LineOptions {
	bool                      smoothDirections = true;
	DirectionSmoothingOptions directions;
	UmbilicOptions            umbilics; // `smoothed` when the field's directions are, now or before
	LineTracingOptions        tracing; // targetVertices 0 and epsilon 0: from the size of the cloud
};

struct TracedLines {
	CurvatureField field; // with the directions that were followed
	UmbilicRegions umbilics;
	VoronoiCells   cells;
	LineNetwork    lines;
};

// A09 section 5: smoothed directions, umbilical regions, Voronoi cells, lines.
TracedLines followDirections(
	const CloudIndex&  index,
	CurvatureField     field,
	const LineOptions& options,
	StageClock&        clock,
	const Progress&    progress);

struct FieldMeshOptions {
	CreaseOptions        creases;
	LineTracingOptions   tracing; // targetVertices, or epsilon, or from the size of the cloud
	double               anisotropy = 1.5; // largest ratio of the line spacings in a place
	MeshFinishingOptions mesh;
	bool                 keepLines = false;         // as polylines, beside the mesh
	double               holeSize  = usualHoleSize; // ScaffoldOptions::holeSize
};

struct FieldMesh {
	Creases                 creases;
	PositionFieldMeshResult mesh;
	bool                    bounded = false; // mostTargetVertices() instead of the number asked for
};

// Creases, the number of vertices, and the mesh of the position field with its lines.
FieldMesh meshOfPositionField(
	const CleanSurface&     surface,
	const FieldMeshOptions& options,
	StageClock&             clock,
	const Progress&         progress);

// How many vertices a mesh of a cloud of n points gets when nobody says: one per 16 points, faces about
// four point spacings wide; small clouds, which show little in so few, up to one per 4 points.
Index automaticTargetVertices(Index n);
// And at most: four per point, edges half a spacing long. More would show what lies between the points.
Index mostTargetVertices(Index n);

} // namespace curvature_lines
