// Outlier rejection: the published votes between operating regions (A09 section 4.1), or the votes of
// larger robust quadrics by height, which also see outliers in clusters and with plausible normals.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "curvature_field.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_curvature.h"

namespace curvature_lines {

struct OutlierOptions {
	enum class Mode { Robust, Paper };
	Mode mode = Mode::Robust;
	// Robust: rejected when farther from the surface than this many errors of a height (Verdict::deviation). Of 20 000
	// normally distributed heights 9 are. By experiment (benchmarks/cleaning.py).
	double sensitivity = 3.5;
	Index  rounds      = 3; // Robust: re-estimation without the points rejected before, at most
	// Robust: hair, grass, foliage (unstructured_points.h) are rejected; else kept, and told.
	bool rejectUnstructured = false;
	// Paper: rejected when more than this share of the votes is against (A09: 1/2).
	double                 voteThreshold = 0.5;
	RobustCurvatureOptions curvature;
};

// The published vote for one given curvature field, one round: a point is flagged when more than
// voteThreshold of its votes are against, or when it is Isolated. W_a[b] > 0 and W_b[a] = 0 is b's vote
// against a; both > 0 is a vote for a (R07 prints the opposite by a copy error).
OutlierResult voteOutliers(const CurvatureField& field, double voteThreshold);

OutlierResult rejectOutliers(
	const CloudIndex& index, const OutlierOptions& options = {}, const Progress& progress = {});

} // namespace curvature_lines
