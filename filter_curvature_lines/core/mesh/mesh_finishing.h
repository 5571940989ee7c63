// The last steps of every quad mesh, whichever method made its faces, and what it is then: holes closed
// (beyond the papers), concave faces cut into convex ones (R07), polygons cut into triangles (A09 section 6
// mentions them).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

enum class QuadKind {
	Pure,      // quads only: what else there is, is joined to them by paths (quad_completion.h)
	Dominant,  // faces as the lines leave them, with some of three, five and more corners
	Subdivided // quads only: a coarser mesh, every face divided from its centre
};

struct MeshFinishingOptions {
	QuadKind quads        = QuadKind::Dominant;
	bool     triangulate  = false; // split every polygon into triangles
	bool     splitConcave = true;  // cut non-quads with a reflex corner into convex pieces (R07)
	bool     closeHoles   = false; // fill boundary loops up to longestClosedHole
};

// Longest perimeter of a hole that closeHoles fills, in edges of the mesh (its median edge, or the one
// planned for it): about three faces wide. By experiment.
constexpr double longestClosedHole = 12.0;

struct FinishedMesh {
	PolygonMesh  mesh;
	MeshTopology topology;
	Index        crossings = 0; // of lines, that its vertices come from
};

// Fills boundary loops whose perimeter is at most longestClosedHole times the median edge with one polygon
// each.
void closeSmallHoles(PolygonMesh& mesh);

// Faces that are no quads are cut at reflex corners. Vertices stay.
PolygonMesh withConvexFaces(const PolygonMesh& mesh);

// Quads only, but for Dominant. Vertices are added; `onFeature` (completeQuads) grows with them.
PolygonMesh withQuads(const PolygonMesh& mesh, QuadKind kind, std::vector<char>& onFeature);

// Triangles only. A vertex is added in a face that no diagonal can cut (PolygonSplitter::triangulate).
PolygonMesh triangulated(const PolygonMesh& mesh);

} // namespace curvature_lines
