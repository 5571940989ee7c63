// A surface that a cloud defines as what a projection leaves in place (Adamson and Alexa 2003): near every
// place a polynomial over a local plane. What the ray tracer knows of a surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "neighborhoods.h"

namespace curvature_lines {

// z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 in the orthonormal frame (u, v, n) at origin.
struct LocalQuadric {
	Eigen::Vector3d             origin, u, v, n;
	Eigen::Matrix<double, 6, 1> c       = Eigen::Matrix<double, 6, 1>::Zero();
	double                      spacing = 0.0; // of the control points around, length

	double height(double x, double y) const
	{
		return c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y);
	}
	// The point below or above `position`, along n.
	Eigen::Vector3d foot(const Eigen::Vector3d& position) const
	{
		const Eigen::Vector3d d = position - origin;
		const double          x = d.dot(u), y = d.dot(v);
		return origin + x * u + y * v + height(x, y) * n;
	}
	Eigen::Vector3d normalAt(const Eigen::Vector3d& position) const // unit
	{
		const Eigen::Vector3d d = position - origin;
		const double          x = d.dot(u), y = d.dot(v);
		return (n - (c[1] + 2.0 * c[3] * x + c[4] * y) * u - (c[2] + c[4] * x + 2.0 * c[5] * y) * v)
			.normalized();
	}
};

class PointSetSurface {
public:
	virtual ~PointSetSurface() = default;
	// Nothing where no control point is near, or where they do not tell. Called from several threads.
	virtual std::optional<LocalQuadric> near(const Eigen::Vector3d& position) const = 0;
};

// The points that define a surface. The cloud and the search must outlive it.
struct ControlPoints {
	const PointCloud&          cloud;
	const NeighborSearch&      search;
	const std::vector<double>& spacing; // per point, length
};

// Control points around a place, all on one sheet.
struct ControlNeighborhood {
	std::vector<Index> points;        // by increasing distance
	double             spacing = 0.0; // of those around, length: changes gradually from place to place

	// The nearest `count` points whose normals do not oppose that of the closest. False where there is no
	// surface: farther than three spacings from the nearest point.
	bool gather(const ControlPoints& control, const Eigen::Vector3d& position, Index count);
};

struct ProjectionOptions {
	double tolerance  = 1e-4; // in local spacings: a point that moves less is on the surface
	Index  iterations = 10;   // projections of one point at most (T06: 2 or 3 suffice)
};

struct ProjectedPoints {
	Eigen::Matrix3Xd positions, normals; // 3 x N; where nothing is near, the position given and no normal
	std::vector<char> projected;         // N
	Index            iterations = 0;     // largest number any point needed
};

// Every point of `positions` (3 x N) projected until it stays.
ProjectedPoints projectPoints(
	const PointSetSurface&   surface,
	const Eigen::Matrix3Xd&  positions,
	const ProjectionOptions& options  = {},
	const Progress&          progress = {});

// `count` places around each of `positions` (3 x M), itself first: evenly spread over the area of one control
// point, in the tangent plane there. Fixed; not yet on the surface.
Eigen::Matrix3Xd
scatterAround(const ControlPoints& control, const Eigen::Matrix3Xd& positions, Index count);

} // namespace curvature_lines
