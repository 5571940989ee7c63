// Patterns by which faces are cut into quads on the way of a path that divides edges: the two ends of a path, the quads in
// between, and what a new corner or an irregular vertex costs. Internal to quad_completion.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "linked_faces.h"
#include "point_cloud.h"

namespace curvature_lines {

// A face cut into quads, as names of points: its corners from the start of the side that a path enters or
// leaves it by, then the middles of the sides divided, then a centre.
struct QuadPattern {
	int                               count;
	std::array<std::array<int, 4>, 5> parts;
};
inline constexpr QuadPattern triangleEnd = {1, {{{0, 3, 1, 2}}}};
inline constexpr QuadPattern pentagonEnd = {2, {{{3, 4, 0, 5}, {3, 5, 1, 2}}}};
// Of quads, by the sides from the one entered to the one left: 1 to 3. The middle of the first is named 4.
inline constexpr std::array<QuadPattern, 3> quadPassages = {
	QuadPattern{3, {{{4, 1, 5, 6}, {5, 2, 3, 6}, {3, 0, 4, 6}}}},
	QuadPattern{2, {{{0, 4, 5, 3}, {4, 1, 2, 5}}}},
	QuadPattern{3, {{{5, 0, 4, 6}, {4, 1, 2, 6}, {2, 3, 5, 6}}}},
};
// A smaller quad in a quad.
inline constexpr QuadPattern quadRing = {
	5, {{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}}};

// Of the corners of a quad, seen along a unit normal (the sign is right for every length); negative: one is concave.
double leastSine(const std::array<Eigen::Vector3d, 4>& corners, const Eigen::Vector3d& normal);
// Of all quads of a pattern.
double leastSine(
	const QuadPattern&                  pattern,
	const std::vector<Eigen::Vector3d>& points,
	const Eigen::Vector3d&              normal);

// The pattern's quads, appended to `parts`.
void addParts(
	const QuadPattern&              pattern,
	const LinkedFaces::Loop&        points,
	std::vector<LinkedFaces::Loop>& parts);

// Costs in the unit of a path's length: one edge that is as long as those around it. They are whole numbers of steps that
// sums keep exactly: equal costs do not differ by rounding, and ties go by number on every order of the points.
constexpr double valenceCost = 1.0; // of every edge that a vertex gets away from the regular number
double inSteps(double cost);
double cornerCost(double leastSine);
double concaveCost(double leastSine); // the part of it that only concave corners have
// Of a vertex that gets so many edges more: by how much it gets away from four, or three on a rim.
double irregularityCost(const LinkedFaces& faces, Index vertex, Index change);

} // namespace curvature_lines
