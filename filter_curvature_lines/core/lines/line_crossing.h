// Where two lines of curvature cross (A09 section 5.2).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// One crossing: a vertex of the mesh, on one line of each family (or on two of the same, if they do
// cross).
struct LineCrossing {
	Eigen::Vector3d position, normal; // midpoint between the two lines, mean of their normals
	Index           line[2];          // the two lines; may be the same one twice
	double          parameter[2]; // position along each: vertex index + fraction, in [0, segments)
	Eigen::Vector3d tangent[2];   // unit direction of each line there
	int             side;         // +1: line[1] goes over to the left of line[0], -1: to its right
};

} // namespace curvature_lines
