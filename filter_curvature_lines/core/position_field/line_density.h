// How many lines of each family a unit of length meets: as the sizes of the scaffold and the target number of vertices
// ask for, closer lines across strong bends, and the correction that makes the lines end as seldom as possible.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

#include "cross_field.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct LineDensityOptions {
	double targetVertices =
		1600.0; // as many as the sizes of the scaffold ask for, or another number
	// largest ratio of the spacings of both families that curvature asks for
	double anisotropy = 1.5;
	// How much uneven spacing costs against lines that end. In a prototype 100, 30, 10, 1 left 44, 2, 0, 0
	// ends on a torus, and at 1 an ellipsoid was twice as far from its mesh as at 10; 3 rather than 5 on
	// noisy ellipsoids, seeds 1 to 10.
	double evenness = 3.0;
};

// Row f: lines of family f per length, met when walking along d1 (f = 0) or d2 (f = 1).
using LineDensity = Eigen::Matrix2Xd; // 2 x V

// The curvature enters in the anisotropy only.
LineDensity lineDensity(
	const Scaffold&           scaffold,
	const CrossField&         field,
	const CurvatureField&     curvature,
	const LineDensityOptions& options);

// Vertices a quad mesh with these lines has: crossings, and lines that meet a rim.
double
expectedVertices(const TriangleMesh& mesh, const CrossField& field, const LineDensity& density);

// The increase of the two phases (real: family 0, imaginary: family 1) along every edge, in lines, in the
// frame at its start. Of an edge that leaves a crease only the other end counts: the frame on the crease is
// tilted against the faces beside it.
Eigen::VectorXcd
expectedRise(const TriangleMesh& mesh, const CrossField& field, const LineDensity& density);

// A triangle in the frame of its corner 0.
struct TriangleField {
	std::array<int, 3>             turns;    // of the frames at the corners against that one
	Eigen::Matrix3d                gradient; // column c: gradient of the hat function of corner c
	std::array<Eigen::Vector3d, 2> target;   // gradients the phases should have
	Eigen::Vector3d                normal;
	double                         area = 0.0;
};
TriangleField triangleField(
	const TriangleMesh& mesh, const CrossField& field, const LineDensity& density, Index triangle);

} // namespace curvature_lines
