// Fewer faces that are no quads. Lines that end leave pentagons, umbilics triangles; pairs of them vanish
// together, with a strip of quads between them split along; near a rim the strip ends there. Every step keeps
// V - E + F.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

struct QuadCleanupOptions {
	// Quads between the two irregular faces, or to the rim. In a prototype, on a torus with evenly spaced
	// lines, 3 made 94.8 % quads 95.6 %, 12 made them 98 % with 10 % more vertices; with traced lines 3
	// made 96.5 % 98.3 %.
	Index longestStrip = 3;
	// Rim edges of triangles, in edges nearby: shorter ones vanish at once, those up to the longest only if
	// the triangle finds no pentagon. By experiment on rims that run across the lines (helicoids).
	double shortestRimEdge = 0.25, longestRimEdge = 1.0;
};

// Cuts large faces, joins triangles with pentagons, inserts strips, and merges the ends of lines at rims.
// `onFeature` marks the vertices on rims and creases and changes with the mesh.
PolygonMesh cleanUpQuads(
	const PolygonMesh& mesh, std::vector<char>& onFeature, const QuadCleanupOptions& options = {});

// A pentagon is taken through the side opposite its flattest corner, a triangle through any side, on
// through opposite sides of quads until another one or a rim: the strip is split in two along its middle. A
// pentagon with one side on a rim is taken through that. Shortest first.
PolygonMesh insertStrips(const PolygonMesh& mesh, std::vector<char>& onFeature, Index longestStrip);

} // namespace curvature_lines
