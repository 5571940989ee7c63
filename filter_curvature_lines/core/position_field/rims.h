// The rims of a scaffold and the corners they turn.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct Rim {
	std::vector<Index> vertices; // of the scaffold, surface on the left
	std::vector<char>  corner;   // of each: the rim turns here

	Index size() const { return static_cast<Index>(vertices.size()); }
	Index at(Index k) const { return vertices[(k % size() + size()) % size()]; }
	bool isCorner(Index k) const { return corner[(k % size() + size()) % size()] != 0; }
	// Along the rim at its k-th vertex, from neighbours on the same side of corners; unit.
	Eigen::Vector3d tangent(Index k, const Eigen::Matrix3Xd& positions) const;
};

std::vector<Rim> findRims(const TriangleMesh& mesh);

} // namespace curvature_lines
