// How far points are from a polygon mesh, and from which face of it.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

// Triangles that stand for the faces: quads are cut along the shorter diagonal, larger faces from their centre.
struct FaceTriangles {
	std::vector<std::array<Eigen::Vector3d, 3>> corners;
	std::vector<Index>                          face; // of each triangle
};
FaceTriangles faceTriangles(const PolygonMesh& mesh);

struct MeshDistance {
	Eigen::VectorXd    distance; // N, lengths; INFINITY from a mesh without faces
	Eigen::Matrix3Xd   foot;     // 3 x N: the nearest point of the mesh
	std::vector<Index> face;     // N: where it is; -1: none
};

// `points` 3 x N. Same result for any number of threads.
MeshDistance distanceToMesh(
	const PolygonMesh& mesh, const Eigen::Matrix3Xd& points, const Progress& progress = {});

} // namespace curvature_lines
