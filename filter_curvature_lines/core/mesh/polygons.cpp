// Disks whose border visits a vertex twice, and compact meshes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygons.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

namespace {

// Width of the ring of quads inside a border that visits a vertex twice, over the way to its centre. Any
// number between 0 and 1 gives the same topology; the ring should not be much narrower than the other
// faces.
constexpr double ringWidth = 0.3;
} // namespace

Polygons::Polygons(const HalfEdgeGraph& graph, const std::vector<std::vector<Index>>& faceLoops)
{
	for (Index v = 0; v < graph.vertexCount(); ++v) {
		vertices.push_back(graph.positions().col(v));
		normals.push_back(graph.normals().col(v));
	}
	for (const std::vector<Index>& loop : faceLoops) {
		std::vector<Index> border;
		border.reserve(loop.size());
		for (const Index h : loop)
			border.push_back(graph.origin(h));
		addDisk(border);
	}
}

void Polygons::addDisk(const std::vector<Index>& border)
{
	std::vector<Index> sorted = border;
	std::sort(sorted.begin(), sorted.end());
	if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
		faces.push_back(border);
		return;
	}
	const Index n = static_cast<Index>(border.size()), first = static_cast<Index>(vertices.size());
	Eigen::Vector3d center = Eigen::Vector3d::Zero();
	for (const Index v : border)
		center += vertices[v] / n;
	std::vector<Index> inner;
	for (Index k = 0; k < n; ++k) {
		const Index v = border[k], w = border[(k + 1) % n];
		vertices.push_back(vertices[v] + ringWidth * (center - vertices[v]));
		normals.push_back(normals[v]);
		faces.push_back({v, w, first + (k + 1) % n, first + k});
		inner.push_back(first + k);
	}
	faces.push_back(inner);
}

PolygonMesh Polygons::mesh(std::vector<Index>* nameOf) const
{
	std::vector<Index> names(vertices.size(), -1), sources;
	for (const std::vector<Index>& face : faces)
		for (const Index v : face)
			names[v] = 0;
	for (std::size_t v = 0; v < names.size(); ++v) {
		if (names[v] < 0)
			continue;
		names[v] = static_cast<Index>(sources.size());
		sources.push_back(static_cast<Index>(v));
	}
	PolygonMesh result;
	result.vertices.resize(3, sources.size());
	result.normals.resize(3, sources.size());
	for (std::size_t v = 0; v < sources.size(); ++v) {
		result.vertices.col(v) = vertices[sources[v]];
		result.normals.col(v)  = normals[sources[v]];
	}
	result.faces = NeighborLists::fromRows(faces);
	for (Index& v : result.faces.indices)
		v = names[v];
	if (nameOf)
		*nameOf = std::move(names);
	return result;
}

} // namespace curvature_lines
