// The field of crosses on the scaffold: principal directions smoothed as far as their errors ask for, with
// the smoothest continuation through umbilic and flat parts (Knoeppel et al. 2013, for crosses; the energy
// of A09 section 4.3 with exp(4 i theta)). A cross is what spheres, flat faces and creases need.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "curvature_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

using Complex = std::complex<double>;

// What is known about the directions at the vertices of the scaffold.
struct DirectionGuide {
	Eigen::Matrix3Xd  normals, directions; // 3 x V, unit; one of the four arms of the cross
	Eigen::VectorXd   weights;             // V, 0: nothing is known
	std::vector<char> onCrease;            // V: the normal is between those of two faces
};

struct CrossField {
	Eigen::Matrix3Xd normals, d1,
		d2;                     // 3 x V: arms of the cross, d2 = n x d1; which two is arbitrary
	std::vector<char> onCrease; // V
	// Per edge: the frame at `to` is turned by so many quarters against the frame at `from` (period jump):
	// z_to = i^turns z_from.
	std::vector<std::uint8_t> turns;
	// Per triangle: the sum of the turns around it, 0..3; not 0: a singular point of the field.
	std::vector<std::uint8_t> index;
};

std::vector<Index> singularTriangles(const CrossField& field);

// Confidence from the standard error of k1 - k2. Vertices on creases and those that are no points of the cloud
// get their normals from the triangles around, and no direction.
DirectionGuide directionGuide(const Scaffold& scaffold, const CurvatureField& curvature);

CrossField smoothCrossField(const TriangleMesh& mesh, const DirectionGuide& guide);

// Turns the crosses by less than a quarter so that they are smooth with the turns, and so the singular points, that the
// field has; they may have been changed.
void smoothWithTurns(const TriangleMesh& mesh, const DirectionGuide& guide, CrossField& field);

// `d` turned with the smallest rotation that takes unit vector `from` to unit vector `to`.
Eigen::Vector3d
transported(const Eigen::Vector3d& d, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// i^quarters z, exactly.
Complex turned(const Complex& z, int quarters);

// Which family of the other frame, and with which sign, is family f (0: real, 1: imaginary part) of
// i^-turns z.
struct FamilyImage {
	int family, sign;
};
FamilyImage familyBehind(int turns, int f);

// Turns of every corner's frame against the one of corner 0: z_c = i^turns z_0.
std::array<int, 3> cornerTurns(const TriangleMesh& mesh, const CrossField& field, Index triangle);

} // namespace curvature_lines
