// Triangles of polygons: found by the sides they share with them, and from there across diagonals.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_triangulation.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"

namespace curvature_lines {

namespace {

using Side = std::pair<Index, Index>; // directed

std::map<Side, Index> facesBySide(const PolygonMesh& polygons)
{
	std::map<Side, Index> faces;
	for (Index f = 0; f < polygons.faceCount(); ++f) {
		const NeighborLists::Row face = polygons.faces[f];
		for (Index c = 0; c < face.size(); ++c)
			faces[{face[c], face[(c + 1) % face.size()]}] = f;
	}
	return faces;
}

// Fills `polygon` and `inner`.
void assignTriangles(const PolygonMesh& polygons, PolygonTriangulation& result)
{
	const std::map<Side, Index> polygonOf = facesBySide(polygons);
	const NeighborLists&        triangles = result.triangles.faces;
	std::map<Side, Index>       acrossDiagonal; // the triangle left of a directed diagonal
	result.polygon.assign(triangles.size(), -1);
	result.inner.assign(3 * triangles.size(), 0);
	std::vector<Index> front;
	for (Index t = 0; t < triangles.size(); ++t)
		for (int c = 0; c < 3; ++c) {
			const Side side{triangles[t][c], triangles[t][(c + 1) % 3]};
			const auto found = polygonOf.find(side);
			if (found == polygonOf.end()) {
				result.inner[3 * t + c] = 1;
				acrossDiagonal[side]    = t;
			}
			else if (result.polygon[t] < 0) {
				result.polygon[t] = found->second;
				front.push_back(t);
			}
		}
	// Triangles with diagonals only belong where their neighbours do.
	for (std::size_t k = 0; k < front.size(); ++k) {
		const Index t = front[k];
		for (int c = 0; c < 3; ++c) {
			if (!result.inner[3 * t + c])
				continue;
			const auto other = acrossDiagonal.find({triangles[t][(c + 1) % 3], triangles[t][c]});
			if (other != acrossDiagonal.end() && result.polygon[other->second] < 0) {
				result.polygon[other->second] = result.polygon[t];
				front.push_back(other->second);
			}
		}
	}
}

// Fills `polygons`; sides within a star are no longer inner ones. A polygon of hosts has no vertex inside.
void dissolveStars(const PolygonMesh& polygons, PolygonTriangulation& result)
{
	const PolygonMesh& triangles = result.triangles;
	std::vector<char>  starred(polygons.faceCount(), 0);
	for (Index t = 0; t < triangles.faceCount(); ++t)
		for (const Index v : triangles.faces[t])
			if (v >= polygons.vertexCount())
				starred[result.polygon[t]] = 1;

	std::vector<std::vector<Index>> faces;
	for (Index f = 0; f < polygons.faceCount(); ++f)
		if (!starred[f])
			faces.emplace_back(polygons.faces[f].begin(), polygons.faces[f].end());
	for (Index t = 0; t < triangles.faceCount(); ++t)
		if (starred[result.polygon[t]]) {
			faces.emplace_back(triangles.faces[t].begin(), triangles.faces[t].end());
			std::fill_n(result.inner.begin() + 3 * t, 3, char(0));
		}
	result.polygons = {triangles.vertices, triangles.normals, NeighborLists::fromRows(faces)};
}

} // namespace

PolygonTriangulation triangulatePolygons(const PolygonMesh& polygons)
{
	PolygonSplitter splitter(polygons);
	splitter.triangulate();
	PolygonTriangulation result;
	result.triangles = splitter.mesh();
	assignTriangles(polygons, result);
	dissolveStars(polygons, result);
	return result;
}

} // namespace curvature_lines
