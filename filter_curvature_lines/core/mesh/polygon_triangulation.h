// Polygons as triangles that remember them: what hosts hold which know no polygons.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct PolygonTriangulation {
	// The polygons, but those that no diagonals cut into triangles: they were cut into stars about a new vertex, and the
	// triangles of a star are faces of their own here. Their vertices are those of the triangles.
	PolygonMesh        polygons;
	PolygonMesh        triangles;
	std::vector<Index> polygon; // of each triangle: the face of the given mesh it is part of
	// 3 per triangle: 1 where the side that starts at this corner lies inside a face of `polygons`
	std::vector<char> inner;
};

// All at once, because a diagonal that is also an edge elsewhere would make the mesh non-manifold.
PolygonTriangulation triangulatePolygons(const PolygonMesh& polygons);

} // namespace curvature_lines
