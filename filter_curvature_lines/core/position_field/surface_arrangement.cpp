// Certificate, repair, and the polygons of the faces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_arrangement.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "disjoint_sets.h"
#include "half_edge_graph.h"
#include "point_cloud.h"
#include "polygons.h"
#include "surface_curves.h"
#include "surface_graph.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// Deletes removable edges between different faces: what stays joins every face to one disk.
void mergeFaces(HalfEdgeGraph& graph, const std::vector<char>& removable)
{
	const auto         loops = graph.faceLoops();
	std::vector<Index> faceOf(2 * graph.edgeCount(), -1);
	for (std::size_t f = 0; f < loops.size(); ++f)
		for (const Index h : loops[f])
			faceOf[h] = static_cast<Index>(f);
	DisjointSets faces(static_cast<Index>(loops.size()));
	for (Index e = 0; e < graph.edgeCount(); ++e)
		if (removable[e] && faces.join(faceOf[2 * e], faceOf[2 * e + 1]))
			graph.removeEdge(e);
}

bool isOutside(const HalfEdgeGraph& graph, const std::vector<Index>& loop)
{
	return std::any_of(loop.begin(), loop.end(), [&](Index h) { return graph.isOutside(h); });
}

// By name of component: V - E + loops, those outside of rims left out, minus its Euler characteristic. Not 0
// either where there is no graph at all.
std::vector<Index>
excessOf(const TriangleMesh& mesh, const std::vector<Index>& component, const SurfaceGraph& drawn)
{
	const HalfEdgeGraph&      graph       = drawn.graph;
	const std::vector<Index>& componentAt = drawn.component;
	std::vector<Index>        excess(mesh.vertexCount(), 0);
	std::vector<char>         empty(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		--excess[component[v]];
		empty[component[v]] = 1;
	}
	for (const auto& edge : mesh.edges())
		++excess[component[edge.from]];
	for (const Triangle& t : mesh.triangles())
		--excess[component[t[0]]];
	for (Index v = 0; v < graph.vertexCount(); ++v) {
		if (graph.around(v).empty())
			continue;
		++excess[componentAt[v]];
		empty[componentAt[v]] = 0;
	}
	for (Index e = 0; e < graph.edgeCount(); ++e)
		if (graph.alive(e))
			--excess[componentAt[graph.edge(e).from]];
	for (const auto& loop : graph.faceLoops())
		if (!isOutside(graph, loop))
			++excess[componentAt[graph.origin(loop[0])]];
	for (std::size_t c = 0; c < empty.size(); ++c)
		if (empty[c])
			excess[c] = 1;
	return excess;
}

// Loops of half-edges that bound faces: those inside rims, of components that are certified.
std::vector<std::vector<Index>>
certifiedFaces(const SurfaceGraph& drawn, const std::vector<Index>& excess)
{
	const HalfEdgeGraph& graph     = drawn.graph;
	const auto           certified = static_cast<Index>(drawn.component.size());
	// Edges that were divided to keep parallel ones apart have new vertices in their middle, at one end of
	// each part. A loop begins with its half-edge of lowest number, which is of a part with an end that was
	// there before.
	const auto componentOf = [&](const std::vector<Index>& loop) {
		const Index v = graph.origin(loop[0]), w = graph.origin(HalfEdgeGraph::twin(loop[0]));
		return drawn.component[v < certified ? v : w];
	};
	std::vector<std::vector<Index>> faces;
	for (std::vector<Index>& loop : graph.faceLoops())
		if (!isOutside(graph, loop) && excess[componentOf(loop)] == 0)
			faces.push_back(std::move(loop));
	return faces;
}

// The mesh's vertices that lie on rims and creases.
std::vector<char>
featureVertices(const HalfEdgeGraph& graph, const std::vector<Index>& nameOf, Index count)
{
	std::vector<char> onFeature(count, 0);
	for (Index v = 0; v < graph.vertexCount(); ++v)
		for (const Index h : graph.around(v))
			if (nameOf[v] >= 0 && graph.edge(h >> 1).isFeature)
				onFeature[nameOf[v]] = 1;
	return onFeature;
}

} // namespace

SurfaceArrangement arrangeOnSurface(
	const TriangleMesh&     mesh,
	const Eigen::Matrix3Xd& normals,
	const SurfaceFeatures&  features,
	const SurfaceCurves&    curves)
{
	SurfaceArrangement       result;
	const std::vector<Index> component = mesh.components();
	std::vector<char>        filled(mesh.vertexCount(), 0);
	const auto               fails = [](Index excess) { return excess != 0; };

	SurfaceGraph drawn = surfaceGraph(mesh, normals, features, curves, component, filled);
	result.crossings   = drawn.crossings;
	drawn.graph.reduce();
	std::vector<Index> excess = excessOf(mesh, component, drawn);
	if (std::any_of(excess.begin(), excess.end(), fails)) {
		std::transform(excess.begin(), excess.end(), filled.begin(), fails);
		drawn = surfaceGraph(mesh, normals, features, curves, component, filled);
		mergeFaces(drawn.graph, drawn.isFilling);
		drawn.graph.reduce();
		excess = excessOf(mesh, component, drawn);
		result.lostComponents =
			static_cast<Index>(std::count_if(excess.begin(), excess.end(), fails));
		result.repairedComponents =
			static_cast<Index>(std::count(filled.begin(), filled.end(), char(1))) -
			result.lostComponents;
	}

	drawn.graph.separateParallelEdges();
	std::vector<Index> nameOf;
	result.mesh      = Polygons(drawn.graph, certifiedFaces(drawn, excess)).mesh(&nameOf);
	result.onFeature = featureVertices(drawn.graph, nameOf, result.mesh.vertexCount());
	return result;
}

} // namespace curvature_lines
