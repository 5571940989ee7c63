// Sharp creases of a cloud as polylines with corners, from where the estimated faces of the surface meet.
// Beyond the papers: A09's lines stop at sharp edges; a mesh needs them as edges of its own.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "neighborhoods.h"

namespace curvature_lines {

struct CreaseOptions {
	// Between the normals of the two faces, degrees. A curve reaches it somewhere; from there it is followed
	// down to 0.6 times this, as creases fade.
	double minAngle = 30.0;
	double spacing  = 0.0; // of the vertices, length, at least 0.05 median point spacings; 0: 0.7 of these
};

// Vertices in order, about evenly spaced. An open curve includes the corners it ends in; of a closed one the
// last vertex joins the first (not repeated).
struct CreaseCurve {
	Eigen::Matrix3Xd positions; // 3 x M
	Eigen::Matrix3Xd tangents;  // 3 x M, unit, in the order of the vertices
	// 3 x M, unit: of the faces to the left and to the right, seen from outside along the tangent. tangent =
	// left x right where convex, right x left where concave.
	Eigen::Matrix3Xd left, right;
	Eigen::VectorXd  angle; // M, between the two normals, radians; positive where convex
	bool             closed = false;
	Index            start = -1, end = -1; // corner at the first and at the last vertex, -1: the crease fades out

	Index  size() const { return static_cast<Index>(positions.cols()); }
	double length() const;
};

struct CreaseCorner {
	Eigen::Vector3d    position = Eigen::Vector3d::Zero();
	std::vector<Index> curves; // that end there, twice if with both ends
};

struct Creases {
	std::vector<CreaseCurve>  curves; // the longest first
	std::vector<CreaseCorner> corners;
};

// The normals must keep to one face, as those of a denoised cloud do (robust_denoising.h). A rim is no crease.
// Same result for any order of the points.
Creases findCreases(
	const PointCloud&           cloud,
	const MinimumNeighborhoods& minimum,
	const CreaseOptions&        options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
