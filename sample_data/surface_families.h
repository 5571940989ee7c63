// What the closed and the open analytic surfaces share, and how the registry gets them.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "analytic_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace curvature_lines::samples {

std::unique_ptr<const AnalyticSurface> makeTorus();
// height 0: a sphere
std::unique_ptr<const AnalyticSurface> makeCapsule(double radius, double height);
std::unique_ptr<const AnalyticSurface> makeCube();
std::unique_ptr<const AnalyticSurface> makeEllipsoid();
std::unique_ptr<const AnalyticSurface> makeCylinder();
std::unique_ptr<const AnalyticSurface> makeHelicoid();
std::unique_ptr<const AnalyticSurface> makeBentSheet();
std::unique_ptr<const AnalyticSurface> makePlane();
std::unique_ptr<const AnalyticSurface> makeCappedCylinder();
std::unique_ptr<const AnalyticSurface> makeLBlock();
std::unique_ptr<const AnalyticSurface> makeDoubleTorus();
std::unique_ptr<const AnalyticSurface> makeHalfTorus();

namespace detail {

using Eigen::AlignedBox3d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double pi       = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

inline SurfaceFrame frameOf(const Vector3d& normal, const Vector3d& d1, double k1, double k2)
{
	return {normal, d1, normal.cross(d1), k1, k2};
}

// Of the level set of a function that grows outward: its Hessian in the tangent plane over its gradient.
inline SurfaceFrame levelSetFrame(const Vector3d& gradient, const Eigen::Matrix3d& hessian)
{
	const double   l  = gradient.norm();
	const Vector3d n  = gradient / l;
	const Vector3d e1 = n.unitOrthogonal(), e2 = n.cross(e1);
	const double   a = e1.dot(hessian * e1) / l, b = e1.dot(hessian * e2) / l,
				 d    = e2.dot(hessian * e2) / l;
	const double mean = 0.5 * (a + d), half = std::hypot(0.5 * (a - d), b);
	const double angle = 0.5 * std::atan2(2.0 * b, a - d);
	return frameOf(n, std::cos(angle) * e1 + std::sin(angle) * e2, mean + half, mean - half);
}

inline AlignedBox3d boxAround(const Vector3d& half)
{
	return {-half, half};
}

// The direction of (x, y), and an arbitrary one on the axis itself.
inline Vector2d radialDirection(const Vector3d& p)
{
	const double r = std::hypot(p.x(), p.y());
	return r > 0.0 ? Vector2d(p.x() / r, p.y() / r) : Vector2d(1.0, 0.0);
}

// rows x columns points of the parameter square, about `points` in all, spaced `aspect` = length of a row
// over length of a column. A closed parameter leaves out its last sample, which is its first.
template<typename PointAt>
Matrix3Xd
parameterGrid(int points, double aspect, bool closedRow, bool closedColumn, const PointAt& pointAt)
{
	const int rows = std::max(2, static_cast<int>(std::lround(std::sqrt(points / aspect))));
	const int columns =
		std::max(2, static_cast<int>(std::lround(static_cast<double>(points) / rows)));
	Matrix3Xd grid(3, rows * columns);
	for (int r = 0; r < rows; ++r) {
		for (int c = 0; c < columns; ++c) {
			const double s = static_cast<double>(c) / (closedRow ? columns : columns - 1);
			const double t = static_cast<double>(r) / (closedColumn ? rows : rows - 1);
			grid.col(r * columns + c) = pointAt(s, t);
		}
	}
	return grid;
}

} // namespace detail
} // namespace curvature_lines::samples
