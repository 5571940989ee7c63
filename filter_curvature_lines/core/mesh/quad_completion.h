// Quad meshes without other faces. Faces with an odd number of corners are joined in pairs by paths from face
// to face; every edge that a path crosses is divided, and the quads on its way are cut in two or, where it
// turns, in three. Our own step beyond A09 section 6, whose meshes keep such faces.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct QuadCompletion {
	PolygonMesh             mesh;         // the vertices given, then new ones
	std::vector<VertexPair> featureEdges; // those given, or their halves
	Index                   paths    = 0; // between two odd faces
	Index                   rimPaths = 0; // from an odd face to a rim
	Index                   left     = 0; // faces that are no quads
};

// Only quads, if no edge has more than two faces or two that disagree about its direction: a closed component
// has an even number of odd faces, in others what finds no partner goes to a rim. Closest pairs first; the
// length of a path counts edges (short ones more), turns, and corners that would not be convex. Faces of six
// and more corners are cut into quads before. No vertex moves; V - E + F, rims, feature edges and the sides
// that faces show stay. `onFeature` marks vertices on rims and creases and grows with the mesh: the middle of
// an edge is marked if it is in `featureEdges` or on a rim, with marked ends.
QuadCompletion completeQuads(
	const PolygonMesh&             mesh,
	std::vector<char>&             onFeature,
	const std::vector<VertexPair>& featureEdges);

// As above with edgesBetween(mesh, onFeature).
QuadCompletion completeQuads(const PolygonMesh& mesh, std::vector<char>& onFeature);

} // namespace curvature_lines
