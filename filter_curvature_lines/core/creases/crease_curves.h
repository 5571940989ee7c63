// Sharp creases as polylines that end in common corners.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

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
	// corner at the first and at the last vertex, -1: the crease fades out
	Index start = -1, end = -1;

	Index size() const { return static_cast<Index>(positions.cols()); }
	double length() const;
	// Unit, at vertex v: halfway between those of the two faces.
	Eigen::Vector3d normal(Index v) const;
	bool concave() const; // in the mean over its vertices
};

struct CreaseCorner {
	Eigen::Vector3d    position = Eigen::Vector3d::Zero();
	std::vector<Index> curves; // that end there, twice if with both ends
};

struct Creases {
	std::vector<CreaseCurve>  curves; // the longest first
	std::vector<CreaseCorner> corners;
};

// What the curves are together.
struct CreaseTotals {
	double length = 0.0; // sum of theirs
	Index  closed = 0, concave = 0;
};

// `unit`: how long a length of 1 is in the units wanted, such as PreparedCloud::diagonal for those of the model.
CreaseTotals totalsOf(const Creases& creases, double unit = 1.0);

} // namespace curvature_lines
