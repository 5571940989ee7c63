// Fewer faces that are no quads. Lines that end leave pentagons, umbilics triangles; pairs of them vanish
// together, with a strip of quads between them split along. Every step keeps V - E + F.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "half_edge_mesh.h"

namespace curvature_lines {

struct QuadCleanupOptions {
	Index longestStrip = 3; // quads between the two
};

// Cuts large faces, joins triangles with pentagons, and inserts strips. `onFeature` marks the vertices on
// rims and creases and grows with the mesh.
PolygonMesh cleanUpQuads(
	const PolygonMesh& mesh, std::vector<char>& onFeature, const QuadCleanupOptions& options = {});

// A pentagon is taken through the side opposite its flattest corner, a triangle through any side, on through
// opposite sides of quads until another one: the strip is split in two along its middle. Shortest first.
PolygonMesh insertStrips(const PolygonMesh& mesh, std::vector<char>& onFeature, Index longestStrip);

} // namespace curvature_lines
