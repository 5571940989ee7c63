// Faces that know what lies across each of their sides, and that can be replaced a few at a time: a polygon
// mesh that changes in places, for the steps that walk from face to face.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// An edge by its two vertices, the lower first.
using VertexPair = std::pair<Index, Index>;

// The edges of which both ends are marked: what is known of the edges along features when only the marks of
// their vertices are. An edge from one feature to another is among them.
std::vector<VertexPair> edgesBetween(const PolygonMesh& mesh, const std::vector<char>& marked);

// A side is a face's part of an edge, named by a number; it leads from one of the face's corners to the next,
// counter-clockwise. Numbers of vertices, faces and sides stay; new ones follow.
class LinkedFaces {
public:
	static constexpr Index rim = -1; // across a side: nothing
	static constexpr Index tangled =
		-2; // across a side: more than one face, or one turned the other way

	using Loop = std::vector<Index>; // of vertices
	struct Split {
		Index side, middle; // the vertex that divides the side
	};

	// `onFeature`: of every vertex, whether it lies on a rim or crease.
	LinkedFaces(
		const PolygonMesh&             mesh,
		const std::vector<char>&       onFeature,
		const std::vector<VertexPair>& featureEdges);

	Index faceCount() const { return static_cast<Index>(m_firstSide.size()); } // replaced ones too
	Index sideCount() const { return static_cast<Index>(m_sides.size()); }
	bool isReplaced(Index face) const { return m_size[face] == 0; }
	Index size(Index face) const { return m_size[face]; } // sides; 0: replaced
	Index firstSide(Index face) const { return m_firstSide[face]; }

	Index faceOf(Index side) const { return m_sides[side].face; }
	Index from(Index side) const { return m_sides[side].from; }
	Index to(Index side) const { return m_sides[next(side)].from; }
	Index across(Index side) const { return m_sides[side].across; } // the same edge's other side
	bool isFeature(Index side) const { return m_sides[side].isFeature; }
	Index next(Index side) const { return along(side, 1); }
	Index previous(Index side) const { return along(side, m_size[faceOf(side)] - 1); }
	// The side of the same face so many further; steps: 0 to the number of sides.
	Index along(Index side, Index steps) const;

	const Eigen::Vector3d& position(Index vertex) const { return m_vertices[vertex]; }
	const Eigen::Vector3d& normal(Index vertex) const { return m_normals[vertex]; }
	bool isOnFeature(Index vertex) const { return m_onFeature[vertex] != 0; }
	// How many edges a vertex has, and whether one of them has not two faces.
	Index valence(Index vertex) const { return m_valence[vertex]; }
	bool isOnRim(Index vertex) const { return m_rims[vertex] != 0; }
	double length(Index side) const { return m_sides[side].length; }
	double meanLength(Index face) const { return m_meanLength[face]; } // of its sides

	// The vertices of a face, from the start of one of its sides.
	Loop loopFrom(Index side) const;
	std::vector<Eigen::Vector3d> positionsOf(const Loop& loop) const;
	Eigen::Vector3d normalOf(const Loop& loop) const; // unit: the mean of its vertices' normals
	Eigen::Vector3d middleOf(Index side) const;

	// In the middle of a side: on a feature if the edge runs along one (a rim does if its ends are marked).
	Index addMiddle(Index side);
	// At the mean of these vertices.
	Index addCenter(const Loop& corners);

	// New faces in the place of others, which they cover: all sides of those but the split ones are sides of
	// the new faces, or lie between two that vanish. Both sides of a split edge are named in `splits`.
	void replace(
		const std::vector<Index>& faces, std::vector<Split> splits, const std::vector<Loop>& parts);

	// Without the faces that were replaced, the new ones last.
	PolygonMesh mesh() const;
	const std::vector<char>& onFeature() const { return m_onFeature; }
	std::vector<VertexPair> featureEdges() const; // sorted

private:
	struct Side {
		Index  from, face, across;
		bool   isFeature;
		double length;
	};
	Index addVertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normalSum, Index like);
	void addFace(const Loop& loop);
	void link(const std::vector<VertexPair>& featureEdges);
	// The edges that a side brings to the vertices at its ends: an inner one is counted by each of its sides at its start.
	void countEdge(Index side, Index change);

	std::vector<Eigen::Vector3d> m_vertices, m_normals;
	std::vector<char>            m_onFeature;
	std::vector<Index>           m_valence,
		m_rims;                  // edges of every vertex, and how many of them are no inner ones
	std::vector<Side>   m_sides; // those of one face follow each other
	std::vector<Index>  m_firstSide, m_size; // of every face
	std::vector<double> m_meanLength;
};

} // namespace curvature_lines
