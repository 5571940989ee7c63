// The rims of a scaffold: where they turn a corner, and where the surface really ends. The front stops at the
// outermost points; the rim they were drawn from lies a little further out, by how densely they lie.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scaffold.h"

namespace curvature_lines {

struct Rim {
	std::vector<Index> vertices; // of the scaffold, surface on the left
	std::vector<char>  corner;   // of each: the rim turns here

	Index size() const { return static_cast<Index>(vertices.size()); }
	Index at(Index k) const { return vertices[(k % size() + size()) % size()]; }
	// Along the rim at its k-th vertex, from neighbours on the same side of corners; unit.
	Eigen::Vector3d tangent(Index k, const Eigen::Matrix3Xd& positions) const;
};

std::vector<Rim> findRims(const TriangleMesh& mesh);

// Moves the vertices of the rims. `normals` are those of the vertices; `noise` that of the cloud's positions
// (standard deviation, a length): it carries points beyond the rim.
void fitRims(
	const std::vector<Rim>& rims,
	const PointCloud&       cloud,
	const Eigen::Matrix3Xd& normals,
	double                  noise,
	Scaffold&               scaffold);

} // namespace curvature_lines
