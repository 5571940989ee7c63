// Projection onto the faces that meet at an edge or a corner.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

namespace curvature_lines {

// One face as seen from a point near it.
struct LocalFace {
	Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // unit
	Eigen::Vector3d center = Eigen::Vector3d::Zero(); // where the face lies, from the point
	double          height = 0.0;                     // of the point above the face's plane
};

struct LocalFaces {
	static constexpr int            capacity = 3;
	std::array<LocalFace, capacity> face; // the first is the point's own
	int                             count = 0;
};

// The move from the point to the nearest place on the faces, cut off where they meet: the surface of
// the intersection of their half spaces at a ridge, of the union at a valley. A point inside all of them
// moves to the nearest. Faces that do neither with the first one count for nothing.
Eigen::Vector3d moveOntoFaces(const LocalFaces& faces);

} // namespace curvature_lines
