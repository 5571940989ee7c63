// How the frames of a position field change from vertex to vertex: along an edge by quarter turns and a whole number of
// lines of either family (a transition function), and what of it is left once around a triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

#include "cross_field.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// A phase x at the far end of side c, in the frame there, is i^-turns[c] x + translation[c] in the frame at corner c.
struct TransitionCircuit {
	std::array<int, 3> turns  = {0, 0, 0}; // 0..3
	std::array<int, 3> before = {
		0, 0, 0}; // sums of the turns of the sides before each corner, 0..3
	std::array<Complex, 3> translation = {0.0, 0.0, 0.0};
	// All the way around: x at corner 0 comes back as i^-index x + sum. Not 0: a singular triangle of the crosses
	int index = 0;
	// in the frame of corner 0; where the index is 0: the lines that end in the triangle
	Complex sum = 0.0;

	// The phase that a singular triangle leaves as it is, in the frame of corner c.
	Complex fixedPoint(int c = 0) const;
	// No line ends in the triangle; if it is singular, its fixed point is a crossing of lines of both families.
	bool isClosed() const;
};

// Of a number that is whole but for rounding.
bool isOdd(double whole);

// `translations`: whole numbers of every edge, from -> to.
TransitionCircuit circuitOf(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const Eigen::VectorXcd& translations,
	Index                   triangle);

} // namespace curvature_lines
