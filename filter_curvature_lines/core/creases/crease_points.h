// Points of creases: where the faces that the estimated normals tell apart intersect. Internal to creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "local_surface.h"
#include "neighborhoods.h"
#include "progress.h"

namespace curvature_lines {

// A place where two faces meet, found from a point on one of them.
struct CreasePoint {
	Eigen::Vector3d position;        // of the crease, nearest to the point
	Eigen::Vector3d tangent;         // unit, with the left face to the left (see creases.h)
	Eigen::Vector3d left, right;     // unit normals of the faces there
	double          angle    = 0.0;  // between them, radians; positive where convex
	double          weight   = 0.0;  // 0..1, small for points far from the crease
	double          spacing  = 0.0;  // of the points around, length
	bool            fromLeft = true; // the point lies on the left face

	// The same seen the other way round.
	CreasePoint reversed() const;
};

struct CreasePoints {
	std::vector<CreasePoint> points;
	// Of the height of a point above the plane that the other points of its own face predict: 1.4826 median |h|,
	// a length. The cloud is denoised, so this is what denoising left.
	double faceDeviation = 0.0;
};

// `elements`: one per point, at the point itself. Pairs of faces at less than minAngle (radians) are none.
CreasePoints findCreasePoints(
	const std::vector<SurfaceElement>& elements,
	const NeighborSearch&              search,
	double                             minAngle,
	const Progress&                    progress = {});

} // namespace curvature_lines
