// Triangles that lines cut off at a rim: where it runs across the lines, two of them end close together.
// Their ends are merged, as if the lines met at the rim. Keeps V - E + F.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "polygon_mesh.h"

namespace curvature_lines {

// Takes the triangles whose side on the rim is up to `longest` of the longest edge at their third corner,
// shortest first. Ends at corners of the rim stay. `onFeature` marks vertices and shrinks with the mesh.
PolygonMesh
mergeRimTriangles(const PolygonMesh& mesh, std::vector<char>& onFeature, double longest);

} // namespace curvature_lines
