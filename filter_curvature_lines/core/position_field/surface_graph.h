// The graph that curves, rims and creases draw on a triangulated surface: A09 section 6 with exact
// bookkeeping. Where curves cross, and in which order, follows from the order of their ends around
// triangles alone.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "surface_curves.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// What is in the mesh whatever the curves do. Rims are always.
struct SurfaceFeatures {
	std::vector<char> edge; // of every edge of the triangles: a piece of a crease
	std::vector<char>
		corner; // of every vertex: a vertex of the mesh when a rim or crease runs through it
};

struct SurfaceGraph {
	HalfEdgeGraph graph; // not reduced
	// Of every vertex of the graph: its component of the surface (TriangleMesh::components).
	std::vector<Index> component;
	// Of every edge of the graph: it is there only because its component is filled.
	std::vector<char> isFilling;
	Index             crossings = 0;
};

// Vertices are the crossings of the curves, their points on edges of the triangles, and the vertices of the
// triangles on rims, on creases, and in `filled` components, of which all edges are in the graph.
// `component` and `filled` are those of the vertices of the triangles; `normals` 3 x V, unit.
SurfaceGraph surfaceGraph(
	const TriangleMesh&       mesh,
	const Eigen::Matrix3Xd&   normals,
	const SurfaceFeatures&    features,
	const SurfaceCurves&      curves,
	const std::vector<Index>& component,
	const std::vector<char>&  filled);

} // namespace curvature_lines
