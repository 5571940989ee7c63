// Polygons over growing arrays of vertices: the way of both methods from the face loops of a graph to a mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct Polygons {
	std::vector<Eigen::Vector3d>    vertices, normals;
	std::vector<std::vector<Index>> faces;

	// The vertices of a graph, and the disks that some of its face loops (of half-edges) bound.
	Polygons(const HalfEdgeGraph& graph, const std::vector<std::vector<Index>>& faceLoops);

	// A disk with this border. One that visits a vertex twice gets a ring of quads along its border, after
	// which no face does: V and F grow by its n corners (F by n for n - 1 + 1), E by 2 n.
	void addDisk(const std::vector<Index>& border);

	// Without vertices that no face uses; `nameOf` tells the new number of every vertex, or -1.
	PolygonMesh mesh(std::vector<Index>* nameOf = nullptr) const;
};

} // namespace curvature_lines
