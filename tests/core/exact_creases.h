// Crease points of exact creases, as findCreasePoints() would see them in a cloud without noise.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "analytic_surfaces.h"
#include "crease_points.h"

namespace curvature_lines::test {

// Position and tangent at a parameter 0..1, and the normals of the faces to the left and to the right.
struct CreaseSection {
	Eigen::Vector3d position, tangent, left, right;
};

// Points `spacing` apart on average along `length` of a curve, at random places, found from either face in turn.
inline void addCrease(
	CreasePoints&                               points,
	double                                      length,
	double                                      spacing,
	samples::Random&                            random,
	const std::function<CreaseSection(double)>& curve,
	double                                      deviation = 0.0)
{
	// a crease is seen from about three points of each face per spacing
	const int count = static_cast<int>(std::lround(6.0 * length / spacing));
	for (int k = 0; k < count; ++k) {
		const CreaseSection at = curve((k + random.uniform()) / count);
		CreasePoint         p;
		p.position         = at.position + deviation * random.normal3();
		p.tangent          = at.tangent;
		p.left             = at.left;
		p.right            = at.right;
		const double angle = std::acos(at.left.dot(at.right));
		p.angle            = at.tangent.dot(at.left.cross(at.right)) > 0.0 ? angle : -angle;
		p.weight           = 1.0;
		p.spacing          = spacing;
		p.fromLeft         = k % 2 == 0;
		// each point sees the crease in its own direction
		points.points.push_back(random.uniform() < 0.5 ? p : p.reversed());
	}
}

inline void addStraightCrease(
	CreasePoints&          points,
	const Eigen::Vector3d& from,
	const Eigen::Vector3d& to,
	const Eigen::Vector3d& left,
	const Eigen::Vector3d& right,
	double                 spacing,
	samples::Random&       random,
	double                 deviation = 0.0)
{
	const auto section = [&](double t) {
		return CreaseSection{from + t * (to - from), (to - from).normalized(), left, right};
	};
	addCrease(points, (to - from).norm(), spacing, random, section, deviation);
}

// The edges of a box around the origin.
inline CreasePoints boxCreases(const Eigen::Vector3d& half, double spacing, double deviation = 0.0)
{
	CreasePoints    points;
	samples::Random random(4, 0);
	for (int axis = 0; axis < 3; ++axis)
		for (const double a : {-1.0, 1.0})
			for (const double b : {-1.0, 1.0}) {
				const int       u = (axis + 1) % 3, v = (axis + 2) % 3;
				Eigen::Vector3d from, to;
				from[axis] = -half[axis];
				to[axis]   = half[axis];
				from[u] = to[u] = a * half[u];
				from[v] = to[v]       = b * half[v];
				Eigen::Vector3d left  = a * Eigen::Vector3d::Unit(u),
								right = b * Eigen::Vector3d::Unit(v);
				if ((to - from).dot(left.cross(right)) < 0.0)
					std::swap(left, right);
				addStraightCrease(points, from, to, left, right, spacing, random, deviation);
			}
	points.faceDeviation = deviation;
	return points;
}

// The rim of a disc of this radius on top of a cylinder: the disc is to the left.
inline CreasePoints
circularCrease(double radius, double spacing, double from = 0.0, double to = 1.0)
{
	CreasePoints    points;
	samples::Random random(6, 0);
	addCrease(points, (to - from) * 2.0 * EIGEN_PI * radius, spacing, random, [=](double t) {
		const double    angle = 2.0 * EIGEN_PI * (from + t * (to - from));
		Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
		return CreaseSection{radius * out, {-out.y(), out.x(), 0.0}, Eigen::Vector3d::UnitZ(), out};
	});
	return points;
}

inline double lengthOf(const CreasePoint& a, const CreasePoint& b)
{
	return (b.position - a.position).norm();
}

} // namespace curvature_lines::test
