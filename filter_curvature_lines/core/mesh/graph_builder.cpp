// Straight edges between vertices that were collected before.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph_builder.h"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

Index GraphBuilder::addVertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal)
{
	m_positions.push_back(position);
	m_normals.push_back(normal);
	return vertexCount() - 1;
}

Index GraphBuilder::addEdge(Index from, Index to)
{
	HalfEdgeGraph::Edge edge;
	edge.from         = from;
	edge.to           = to;
	edge.tangentTo    = m_positions[from] - m_positions[to];
	edge.tangentFrom  = -edge.tangentTo;
	edge.middle       = 0.5 * (m_positions[from] + m_positions[to]);
	edge.middleNormal = (m_normals[from] + m_normals[to]).normalized();
	m_edges.push_back(edge);
	return 2 * edgeCount() - 2;
}

std::vector<Index> GraphBuilder::addPath(const std::vector<Index>& vertices)
{
	std::vector<Index> halfEdges;
	for (std::size_t k = 1; k < vertices.size(); ++k)
		halfEdges.push_back(addEdge(vertices[k - 1], vertices[k]));
	return halfEdges;
}

HalfEdgeGraph GraphBuilder::graph() const
{
	return {asColumns(m_positions), asColumns(m_normals), m_edges};
}

HalfEdgeGraph GraphBuilder::graph(
	const std::vector<std::vector<Index>>& around, const std::vector<char>& kept) const
{
	return {asColumns(m_positions), asColumns(m_normals), m_edges, around, kept};
}

} // namespace curvature_lines
