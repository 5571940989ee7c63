// Quad meshes from any polygons, with four times as many faces: every face is cut around its centre.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "linked_faces.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct QuadSubdivision {
	PolygonMesh             mesh;         // the vertices given, then new ones
	std::vector<VertexPair> featureEdges; // the halves of those given
};

// A face of n corners becomes n quads, from its centre to the middles of its sides (the topology of
// Catmull-Clark 1978, without its smoothing). No vertex moves; V - E + F, rims and the sides that faces show
// stay. An edge has two faces at most. `onFeature` grows as in completeQuads().
QuadSubdivision subdivided(
	const PolygonMesh&             mesh,
	std::vector<char>&             onFeature,
	const std::vector<VertexPair>& featureEdges);

// As above with edgesBetween(mesh, onFeature).
QuadSubdivision subdivided(const PolygonMesh& mesh, std::vector<char>& onFeature);

} // namespace curvature_lines
