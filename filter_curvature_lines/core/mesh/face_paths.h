// Shortest paths from face to face through quads (Dijkstra 1959 in the dual mesh): the ways by which odd faces find each
// other. Internal to quad_completion.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <vector>

#include "linked_faces.h"
#include "point_cloud.h"
#include "shortest_paths.h"

namespace curvature_lines {

// Of an odd number of corners, and not replaced.
bool isOddFace(const LinkedFaces& faces, Index face);
// The side is the common edge of two triangles.
bool joinsTriangles(const LinkedFaces& faces, Index side);

struct FacePath {
	std::vector<Index>
		sides; // by which every face of it is left, the last to another odd face or a rim; empty: no path
	double cost    = std::numeric_limits<double>::infinity(); // quad_patterns.h
	bool   endless = false;                                   // there may be one beyond reach
};

// The shortest path from an odd face, through quads, to another or to a rim. A path costs its edges (up to two for one that
// is shorter than those around), turns, and the corners of the quads that it leaves behind (quad_patterns.h). It visits a
// face once.
class FacePathSearch {
public:
	// The faces may change between two searches.
	explicit FacePathSearch(const LinkedFaces& faces) : m_faces(faces) {}

	// `reach`: the largest cost looked at.
	FacePath nearest(Index start, double reach);

private:
	void pass(Index entered);
	// `entered`: the side that the face was entered by; rim: it is the first.
	void leave(Index side, double cost, Index entered);
	double crossingCost(Index side) const;
	// Of a path that begins or ends at this side of an odd face.
	double endCost(Index side) const;
	// Of two odd faces with a common side.
	double joinCost(Index side) const;
	// Every face once: where the path comes back to one, the round trip goes.
	std::vector<Index> sidesOfBest() const;

	const LinkedFaces& m_faces;
	// Nodes: sides that faces are entered by; before: the one that the face before was entered by.
	ShortestPaths m_paths;
	Index         m_start = -1;
	// The best path so far: its cost, how its last face is entered, and the side it is left by.
	double m_bestCost    = std::numeric_limits<double>::infinity();
	Index  m_bestEntered = -1, m_last = -1;
};

} // namespace curvature_lines
