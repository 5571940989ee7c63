// Curves on a triangulated surface as combinatorics: points on its edges, and in every triangle chords that
// join them. Every edge point is one object, shared by both triangles, so curves cannot tear.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "cross_field.h"
#include "point_cloud.h"
#include "position_field.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct EdgePoint {
	double t      = 0.0; // from edge.from to edge.to, within (0, 1)
	int    family = 0;   // in the frame at edge.from
};

struct SurfaceCurves {
	struct End {
		Index edge;  // -1: it ends at a vertex of the triangles
		Index point; // index into points[edge], or the vertex
	};
	struct Chord {
		Index triangle;
		End   a; // on an edge
		End   b; // on another edge, or at the vertex across
	};
	std::vector<std::vector<EdgePoint>> points; // of every edge, by increasing t
	std::vector<Chord>                  chords; // by triangle
	Index ends = 0; // edge points without a chord in one of their triangles
};

// The lines on which a phase is an integer. Pinned vertices have integers exactly: the line that runs
// through them along a rim or crease is the rim or crease itself, and one that comes from elsewhere ends at them. So do
// those at `crossing` vertices, where both phases are integers whatever positions.phase says.
SurfaceCurves integerLines(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const PositionField&     positions,
	const std::vector<char>& crossing = {});

// Which points on the sides of a triangle belong together, for curves that do not cross: as many as possible
// go around a corner, nested. Side c runs from corner c to corner c + 1.
struct SidePoint {
	int side, index;
};
std::vector<std::pair<SidePoint, SidePoint>> matchSides(const std::array<int, 3>& counts);

} // namespace curvature_lines
