// A triangulated surface with its edges: what every stage between the cloud and the quad mesh works on.
// Vertices, edges and triangles are numbered; an edge is one object, shared by its two triangles.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

using Triangle = std::array<Index, 3>; // counter-clockwise seen from outside

// Those triangles, in order, that leave every edge with at most two triangles that run along it in opposite
// directions. Vertices whose triangles do not form one fan are split: their copies get new numbers from
// `vertexCount` on, and their originals are appended to `copyOf`.
std::vector<Triangle>
manifoldPart(const std::vector<Triangle>& triangles, Index vertexCount, std::vector<Index>& copyOf);

class TriangleMesh {
public:
	struct Edge {
		Index from, to; // from < to
		Index left  = -1,
			  right = -1; // triangle that runs along the edge from -> to, and back; -1: a rim
		bool isRim() const { return left < 0 || right < 0; }
	};

	TriangleMesh() = default;
	// `triangles`: two-manifold and oriented (manifoldPart).
	TriangleMesh(Eigen::Matrix3Xd vertices, std::vector<Triangle> triangles);

	Eigen::Matrix3Xd vertices; // 3 x V; may be moved

	Index vertexCount() const { return static_cast<Index>(vertices.cols()); }
	Index edgeCount() const { return static_cast<Index>(m_edges.size()); }
	Index triangleCount() const { return static_cast<Index>(m_triangles.size()); }
	const std::vector<Triangle>& triangles() const { return m_triangles; }
	const std::vector<Edge>& edges() const { return m_edges; }

	// The edge from corner c of a triangle to corner c + 1, and whether the triangle runs along it forwards.
	Index edgeOf(Index triangle, int c) const { return m_sides[triangle][c]; }
	bool isForward(Index triangle, int c) const
	{
		return m_edges[m_sides[triangle][c]].left == triangle;
	}
	Index edgeBetween(Index a, Index b) const; // -1: none

	Eigen::Vector3d along(Index edge) const
	{
		return vertices.col(m_edges[edge].to) - vertices.col(m_edges[edge].from);
	}
	Eigen::Vector3d
	areaVector(Index triangle) const; // along the outward normal, as long as the area

	Eigen::VectorXd vertexAreas() const;    // a third of the triangles around
	Eigen::Matrix3Xd vertexNormals() const; // unit, of the triangles around
	// Half the sum of the cotangents opposite each edge, within [0.05, 3]: weights of differences.
	Eigen::VectorXd cotangentWeights() const;

	// Vertex loops with the surface on the left.
	std::vector<std::vector<Index>> rims() const;
	std::vector<Index>
	components() const; // of every vertex: the smallest vertex it hangs together with
	Index eulerCharacteristic() const; // V - E + T over used vertices

private:
	std::vector<Triangle> m_triangles, m_sides;
	std::vector<Edge>     m_edges; // sorted by (from, to)
};

} // namespace curvature_lines
