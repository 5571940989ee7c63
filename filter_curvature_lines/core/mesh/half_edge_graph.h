// The half-edge structure of an embedded graph: vertices with cyclically sorted half-edges,
// reductions that keep the Euler number, and face loops (A09 section 6; Marinov & Kobbelt 2004).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// A graph embedded in a surface. Half-edge 2e and 2e + 1 are the two sides of edge e.
class HalfEdgeGraph {
public:
	struct Edge {
		Index           from, to;
		Eigen::Vector3d tangentFrom, tangentTo; // directions leaving each end along the edge
		Eigen::Vector3d middle, middleNormal;   // a point of the surface about half-way along
		bool            isFeature = false;      // a piece of a rim or crease: stays
		// along rims: 0 or 1, half-edge 2e or 2e + 1 runs outside
		signed char outside = -1;
	};

	// Half-edges are sorted by their tangents.
	HalfEdgeGraph(Eigen::Matrix3Xd positions, Eigen::Matrix3Xd normals, std::vector<Edge> edges);

	// Half-edges are in the order given: the embedding is exact and tangents are not used. Every vertex of
	// degree two dissolves then, unless it is `kept`, and every face of two sides goes.
	HalfEdgeGraph(
		Eigen::Matrix3Xd                positions,
		Eigen::Matrix3Xd                normals,
		std::vector<Edge>               edges,
		std::vector<std::vector<Index>> around,
		std::vector<char>               kept);

	static Index twin(Index h) { return h ^ 1; }
	Index origin(Index h) const { return h & 1 ? m_edges[h >> 1].to : m_edges[h >> 1].from; }
	const Eigen::Vector3d& tangent(Index h) const
	{
		return h & 1 ? m_edges[h >> 1].tangentTo : m_edges[h >> 1].tangentFrom;
	}
	// Half-edges leaving v, counter-clockwise about its normal.
	const std::vector<Index>& around(Index v) const { return m_around[v]; }

	// Each reduction returns whether it changed anything, and leaves V - E + F as it was as long as
	// the faces it merges are disks.
	bool removeEdge(Index edge); // merges the faces on its two sides
	bool cutDanglingEdges();     // chains that end in a vertex of degree one, repeatedly
	bool dissolveDegreeTwo();    // joins the two edges of a vertex where they continue each other
	bool removeDigons(); // one side of faces with two sides, of which it keeps open ones unless the
						 // embedding is exact; faces with one side
	void reduce();       // all of them until nothing changes

	// Puts vertices on edges that join the same two vertices as another, or a vertex with itself,
	// so that a pair of vertices names an edge.
	void separateParallelEdges();

	// Whether a half-edge runs along the outside of a rim.
	bool isOutside(Index h) const { return m_edges[h >> 1].outside == (h & 1); }

	// Arriving at v by h, a face goes on with the clockwise next of twin(h). Every live half-edge
	// is in exactly one loop.
	std::vector<std::vector<Index>> faceLoops() const;

	Index eulerCharacteristic() const; // V - E + loops, isolated vertices left out

	const Eigen::Matrix3Xd& positions() const { return m_positions; }
	const Eigen::Matrix3Xd& normals() const { return m_normals; }
	bool alive(Index edge) const { return m_alive[edge] != 0; }
	Index edgeCount() const { return static_cast<Index>(m_edges.size()); }
	Index vertexCount() const { return static_cast<Index>(m_around.size()); }
	const Edge& edge(Index e) const { return m_edges[e]; }

private:
	bool isThin(Index edgeA, Index edgeB) const;
	bool continuesStraight(Index vertex) const;
	void splitEdge(Index edge);
	Index addVertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal);

	Eigen::Matrix3Xd                m_positions, m_normals;
	std::vector<Edge>               m_edges;
	std::vector<char>               m_alive;
	std::vector<char>               m_kept; // per vertex; empty unless the embedding is exact
	std::vector<std::vector<Index>> m_around;
};

} // namespace curvature_lines
