// Edits of a few quads of a mesh that keep it a surface of the same kind: two opposite corners of a quad become one, or the edge
// between two quads turns (Tarini et al. 2010: diagonal collapse, edge rotation). Tried, judged, and taken back.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

class QuadEdits {
public:
	// Corner `merged` of a quad goes to the opposite one, `kept`, which is then at `position`; the quad is gone.
	struct Merge {
		Index           face = -1, kept = -1, merged = -1;
		Eigen::Vector3d position, normal;
	};
	// The edge from a corner of a quad to the next one turns to the next two corners, of the six its two quads have: against
	// the clock (`forward`) or with it.
	struct Turn {
		Index face = -1, corner = 0;
		bool  forward = true;
	};
	using Edit = std::variant<Merge, Turn>;
	// What an edit changes, as it was.
	struct Undo {
		std::vector<std::pair<Index, std::vector<Index>>> loops, faces; // of faces, of vertices
		Index                                             kept = -1;    // a vertex that has moved
		Eigen::Vector3d                                   position, normal;
	};

	// Vertices on features (`onFeature`, of every vertex) stay where they are, edges between two of them do not turn.
	// Merges move vertices of `mesh`; its faces stay, loops() has them as they become.
	QuadEdits(const std::vector<char>& onFeature, PolygonMesh& mesh);

	// None for faces that are no quads. Merges: of faces with all corners inside. Of an edge of two faces both list the turns.
	std::vector<Edit> mergesOf(Index face) const;
	std::vector<Edit> turnsOf(Index face) const;

	// False: the surface would not be one any more, or a vertex would have too few or too many edges; then take it back.
	bool apply(const Edit& edit, Undo& undo);
	void restore(const Undo& undo);

	const std::vector<std::vector<Index>>& loops() const { return m_loops; } // empty: gone
	std::vector<Index> facesAround(const std::vector<Index>& vertices) const;
	double jacobianOf(Index face) const; // scaledJacobian()

private:
	std::vector<Index> cornersOf(const std::vector<Index>& faces) const;
	Index surplus(Index vertex) const;
	Index across(Index face, Index corner) const;
	void remember(const std::vector<Index>& faces, Undo& undo) const;
	void unlink(Index face);
	void link(Index face, std::vector<Index> loop);
	void dissolve(Index vertex);
	void merge(const Merge& way);
	void turn(const Turn& way);
	bool isSurface(const Undo& undo, const std::vector<Index>& surplusBefore) const;

	const std::vector<char>&        m_onFeature;
	PolygonMesh&                    m_mesh;
	std::vector<std::vector<Index>> m_loops; // of every face
	std::vector<std::vector<Index>> m_faces; // of every vertex
};

// The mesh with other faces and without the vertices that none of them has; `onFeature` follows. Empty loops are left out.
void replaceFaces(
	const std::vector<std::vector<Index>>& loops, std::vector<char>& onFeature, PolygonMesh& mesh);

} // namespace curvature_lines
