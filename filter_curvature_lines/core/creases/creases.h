// Sharp creases of a cloud as polylines with corners, from where the estimated faces of the surface meet.
// Beyond the papers: A09's lines stop at sharp edges; a mesh needs them as edges of its own.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "crease_curves.h"
#include "progress.h"

namespace curvature_lines {

struct CreaseOptions {
	// Between the normals of the two faces, degrees. A curve reaches it somewhere; from there it is followed
	// down to 0.6 times this, as creases fade.
	double minAngle = 30.0;
	// of the vertices, length, at least 0.05 median point spacings; 0: 0.7 of these
	double spacing = 0.0;
};

// The normals must keep to one face, as those of a denoised cloud do (robust_denoising.h). A rim is no crease.
// Same result for any order of the points.
Creases findCreases(
	const CloudIndex& index, const CreaseOptions& options = {}, const Progress& progress = {});

} // namespace curvature_lines
