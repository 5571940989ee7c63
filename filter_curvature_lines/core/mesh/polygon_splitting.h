// Polygons cut into better ones without moving a vertex: large faces into quads, triangle-pentagon
// pairs into quads, concave faces into convex ones (R07), any face into triangles. Each keeps V - E
// + F.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// A polygon mesh that changes. Invariant: at most one edge joins two vertices.
class PolygonSplitter {
public:
	explicit PolygonSplitter(const PolygonMesh& mesh);

	void cutLargeFaces();     // six corners and more: quads with right angles first
	void pairWithPentagons(); // a triangle and a pentagon with a common edge: two quads
	void splitConcaveFaces(); // faces that are no quads, at corners above 185 degrees
	void triangulate();

	PolygonMesh mesh() const;

private:
	using Face = std::vector<Index>;
	struct Cut {
		Index  i = -1, j = -1; // corners of the face
		double error = 0.0;
	};
	enum class Diagonals { Inside, Any };
	// The cheapest cut among the corner pairs that `error` gives a finite cost.
	template<class Error>
	Cut bestCut(const Face& face, const Error& error, Diagonals = Diagonals::Inside) const;
	template<class Error>
	void cutWhileAny(const Error& error, Diagonals = Diagonals::Inside);
	bool cut(const Face& face, const Cut& cut, Face& first, Face& second);
	bool isEdge(Index a, Index b) const { return m_edges.count(key(a, b)) != 0; }
	static std::uint64_t key(Index a, Index b);

	std::vector<Eigen::Vector3d>      m_vertices, m_normals;
	std::vector<Face>                 m_faces;
	std::unordered_set<std::uint64_t> m_edges;
};

} // namespace curvature_lines
