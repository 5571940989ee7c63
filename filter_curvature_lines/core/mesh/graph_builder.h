// Vertices and edges of an embedded graph, collected one by one: what both arrangements (of traced lines,
// of curves on a triangulated surface) make of lines and the points where they cross. A09 section 6: the
// piece of a line between two crossings that follow each other is an edge.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"

namespace curvature_lines {

class GraphBuilder {
public:
	// `normal`: unit.
	Index addVertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal);

	// A straight edge. Returns its half-edge that leaves `from`; its twin leaves `to`.
	Index addEdge(Index from, Index to);

	// Straight edges from each of the vertices to the next. Returns, for every vertex but the last, the
	// half-edge that leaves it forwards; the one that leaves vertex k + 1 backwards is the twin of number
	// k.
	std::vector<Index> addPath(const std::vector<Index>& vertices);

	HalfEdgeGraph::Edge& edgeOf(Index halfEdge) { return m_edges[halfEdge >> 1]; }
	const Eigen::Vector3d& position(Index vertex) const { return m_positions[vertex]; }
	Index vertexCount() const { return static_cast<Index>(m_positions.size()); }
	Index edgeCount() const { return static_cast<Index>(m_edges.size()); }

	// Half-edges are sorted around vertices by the tangents of their edges.
	HalfEdgeGraph graph() const;
	// Half-edges are `around` every vertex in the order given: the embedding is exact. `kept`: of every
	// vertex, it stays one even with two edges only.
	HalfEdgeGraph
	graph(const std::vector<std::vector<Index>>& around, const std::vector<char>& kept) const;

private:
	std::vector<Eigen::Vector3d>     m_positions, m_normals;
	std::vector<HalfEdgeGraph::Edge> m_edges;
};

} // namespace curvature_lines
