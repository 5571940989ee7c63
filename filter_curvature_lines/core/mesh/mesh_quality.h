// What may be wrong with a polygon mesh of a cloud, in numbers a user can act on.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

// Faces whose side is against the normals of their vertices.
Index foldedFaces(const PolygonMesh& mesh);

// Of faces that are quads, the least sine of a corner's angle, signed by whether the corner turns with the normals of its
// vertices: the scaled Jacobian. Below 0: not convex.
double scaledJacobian(const PolygonMesh& mesh, Index face);
// Of a face that is no mesh's yet. `vertices`, `normals`: 3 x V.
double scaledJacobian(
	const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xd& normals, NeighborLists::Row face);

struct MeshCoverage {
	Index  uncovered  = 0;   // points farther from the mesh than two mean edges of its nearest face
	double largestGap = 0.0; // of a point from the mesh, a length; INFINITY without faces
};

// `points`, 3 x N: those the mesh is to show.
MeshCoverage
coverageOf(const PolygonMesh& mesh, const Eigen::Matrix3Xd& points, const Progress& progress = {});

} // namespace curvature_lines
