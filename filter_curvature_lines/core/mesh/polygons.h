// Polygons over growing arrays of vertices, on the way from face loops to a mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "half_edge_graph.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct Polygons {
	std::vector<Eigen::Vector3d>    vertices, normals;
	std::vector<std::vector<Index>> faces;

	explicit Polygons(const HalfEdgeGraph& graph); // vertices only

	// A disk with this border. One that visits a vertex twice gets a ring of quads along its border, after
	// which no face does: V and F grow by its n corners (F by n for n - 1 + 1), E by 2 n.
	void addDisk(const std::vector<Index>& border);

	// Without vertices that no face uses; `nameOf` tells the new number of every vertex, or -1.
	PolygonMesh mesh(std::vector<Index>* nameOf = nullptr) const;
};

} // namespace curvature_lines
