// The last steps of every quad mesh, whichever method made its faces, and what it is then: holes closed and texture
// coordinates (beyond the papers), concave faces cut into convex ones (R07), polygons cut into triangles (A09 section 6
// mentions them).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "texture_charts.h"

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
	bool     textureCoordinates = false;
};

// Longest perimeter of a hole that closeHoles fills, in edges of the mesh (its median edge, or the one
// planned for it): about three faces wide. By experiment.
constexpr double longestClosedHole = 12.0;

struct FinishedMesh {
	PolygonMesh  mesh;
	MeshTopology topology;
	Index        crossings = 0; // of lines, that its vertices come from
	// If asked for, else empty; of the corners of `mesh`
	TextureCoordinates texture;
};

// Fills boundary loops whose perimeter is at most longestClosedHole times the median edge with one polygon
// each.
void closeSmallHoles(PolygonMesh& mesh);

// Faces that are no quads are cut at reflex corners. Vertices stay.
PolygonMesh withConvexFaces(const PolygonMesh& mesh);

// Quads only, but for Dominant. Vertices are added; `onFeature` (completeQuads) grows with them.
PolygonMesh withQuads(const PolygonMesh& mesh, QuadKind kind, std::vector<char>& onFeature);

// What comes last: texture coordinates of the faces as they are, with seams at creases (bent edges between vertices
// `onFeature`); then triangles, which keep them; and the counts. A vertex is added in a face that no diagonal can cut
// (PolygonSplitter::triangulate).
void finish(FinishedMesh& result, std::vector<char> onFeature, const MeshFinishingOptions& options);

} // namespace curvature_lines
