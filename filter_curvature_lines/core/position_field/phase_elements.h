// The pieces of the scaffold over which the phases of a position field are affine: triangles, and the three parts of a
// singular triangle around its fixed point.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

#include "cross_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// In the frame of its first corner.
struct PhaseElement {
	Index                triangle = -1;
	std::array<Index, 3> vertex   = {-1, -1, -1}; // -1: the fixed point of a singular triangle
	// The phase at corner c is i^-turns phase + whole, or whole alone at a fixed point.
	std::array<int, 3>             turns = {0, 0, 0};
	std::array<Complex, 3>         whole = {0.0, 0.0, 0.0};
	Eigen::Matrix3d                gradient; // column c: of the hat function of corner c
	std::array<Eigen::Vector3d, 2> target;   // gradients the phases should have
	Eigen::Vector3d                normal;
	double                         area = 0.0;

	std::array<Complex, 3> phases(const Eigen::VectorXcd& phase) const
	{
		std::array<Complex, 3> result = whole;
		for (int c = 0; c < 3; ++c)
			if (vertex[c] >= 0)
				result[c] += turned(phase[vertex[c]], -turns[c]);
		return result;
	}
	// Cells that the element should cover.
	double cells() const { return area * target[0].norm() * target[1].norm(); }
};

// Of any triangle, as if it were not singular.
PhaseElement wholeTriangle(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const LineDensity&       density,
	Index                    triangle,
	const TransitionCircuit& circuit);

// The three parts of a singular triangle.
std::array<PhaseElement, 3> partsAroundFixedPoint(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const LineDensity&       density,
	Index                    triangle,
	const TransitionCircuit& circuit);

} // namespace curvature_lines
