// Sizes that follow what a first mesh leaves out: tips and ridges between its lines.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "scaffold.h"

namespace curvature_lines {

struct SizeFeedbackOptions {
	// Distance from the mesh that is accepted, in median sizes, or a length if that is not 0; and the most that a size
	// shrinks by.
	double accepted = 0.2, acceptedLength = 0.0, leastFactor = 0.4;
	// How much the number of vertices that the sizes ask for may grow: where more is left out, more is accepted.
	double mostGrowth = 1.6;
	double gradation  = 0.4; // SizingOptions::gradation
};

// What `accepted` is as a length.
double acceptedDistance(const Scaffold& scaffold, const SizeFeedbackOptions& options = {});

// Vertices of the scaffold that are farther from the mesh than accepted.
struct LeftOut {
	Index  vertices = 0;
	double weight   = 0.0; // each counts by the square of its distance over the accepted one
	double worst    = 0.0; // the largest distance over the accepted one
};

// Shrinks their sizes, and those around, as far as the growth allows.
LeftOut shrinkSizesWhereFar(
	const PolygonMesh& mesh, Scaffold& scaffold, const SizeFeedbackOptions& options = {});

} // namespace curvature_lines
