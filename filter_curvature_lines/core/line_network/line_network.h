// The lines of curvature of both families as polylines: what tracing and the position field give, and what
// crossings and meshes are made from.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

enum class LineEnd {
	None,    // of closed lines
	Line,    // the next line of the family is too close, or an earlier part of this one
	Rim,     // the cloud ends
	Crease,  // the surface or the field turns sharply
	Umbilic, // directions are lost, or do not go on into or out of an umbilical region
	Length,  // longer than any line should be
};

// All lines of both families. Vertices of line l: [offsets[l], offsets[l + 1]), in order along the line;
// a closed line's last vertex joins its first (not repeated).
struct LineNetwork {
	Eigen::Matrix3Xd   vertices, normals; // 3 x M
	Eigen::VectorXd    curvature;         // M, principal curvature along the line
	std::vector<Index> offsets = {0};
	std::vector<int>   family; // per line, 1 (along d1) or 2
	std::vector<char>  closed; // per line
	// per line, before its first and after its last vertex
	std::vector<std::array<LineEnd, 2>> ends;
	double                              epsilon = 0.0; // the one used, fraction of the diagonal
	Index crossings = 0; // of the two families, as LineRegistry counts them

	Index lines() const { return static_cast<Index>(family.size()); }
};

// Per vertex: its distance from the first of its line, along the line.
Eigen::VectorXd arcLengths(const LineNetwork& lines);

Index segmentCount(const LineNetwork& lines, Index line);
bool isClosed(const LineNetwork& lines, Index line); // marked so, and long enough to be

// Point of a polyline at a parameter.
Eigen::Vector3d pointOnLine(const LineNetwork& lines, Index line, double parameter);

} // namespace curvature_lines
