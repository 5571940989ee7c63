// Triangles between points of a surface: CGAL's advancing front (Cohen-Steiner and Da 2004).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "triangle_mesh.h"

namespace curvature_lines {

// Triangles without an edge longer than the `longestEdge` (N, lengths) of both its ends, sorted by their
// vertices; oriented alike where they hang together, to either side. Points whose `normals` (3 x N, unit, or
// zero where there is none) oppose each other are of two sheets, and joined only where nothing else is left.
std::vector<Triangle> advancingFront(
	const Eigen::Matrix3Xd& points,
	const Eigen::Matrix3Xd& normals,
	const Eigen::VectorXd&  longestEdge);

} // namespace curvature_lines
