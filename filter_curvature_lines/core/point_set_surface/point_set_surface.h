// A surface that a cloud defines as what a projection leaves in place (Adamson and Alexa 2003): near every
// place a polynomial over a local plane. What the ray tracer knows of a surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 in the orthonormal frame (u, v, n) at origin.
struct LocalQuadric {
	Eigen::Vector3d             origin, u, v, n;
	Eigen::Matrix<double, 6, 1> c = Eigen::Matrix<double, 6, 1>::Zero();

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

// Called from several threads.
class PointSetSurface {
public:
	virtual ~PointSetSurface() = default;

	// The control points for near() at a place; false where there is no surface.
	bool gather(const Eigen::Vector3d& place, ControlNeighborhood& around) const
	{
		return around.gather(m_control, place, m_nearReach);
	}
	// Those for follow() up to `margin` local spacings from a control point.
	bool gather(Index point, double margin, ControlNeighborhood& around) const
	{
		return around.gather(m_control, point, m_followReach + margin);
	}
	// Nothing where the points around do not tell.
	virtual std::optional<LocalQuadric>
	near(const ControlNeighborhood& around, const Eigen::Vector3d& place) const = 0;
	// A first approximation at the control point that `around` was gathered for: near(), or quicker.
	virtual std::optional<LocalQuadric>
	roughlyAt(const ControlNeighborhood& around, const Eigen::Vector3d& place) const
	{
		return near(around, place);
	}
	// The same as near() for a place less than a spacing away from that of `quadric`, which is replaced: what
	// may be kept of it saves time. False where the points around do not tell.
	virtual bool follow(
		const ControlNeighborhood& around,
		const Eigen::Vector3d&     place,
		LocalQuadric&              quadric) const = 0;

protected:
	// How far around a place near() and follow() look, in local spacings.
	PointSetSurface(const ControlPoints& control, double nearReach, double followReach) :
			m_control(control), m_nearReach(nearReach), m_followReach(followReach)
	{
	}

private:
	ControlPoints m_control;
	double        m_nearReach, m_followReach;
};

struct ProjectionOptions {
	double tolerance  = 1e-4; // in local spacings: a point that moves less is on the surface
	Index  iterations = 10;   // projections of one point at most (T06: 2 or 3 suffice)
};

struct ProjectedPoints {
	// 3 x N; where nothing is near, the position given and no normal
	Eigen::Matrix3Xd  positions, normals;
	std::vector<char> projected;      // N
	Index             iterations = 0; // largest number any point needed
};

// Every point of `positions` (3 x N) projected until it stays.
ProjectedPoints projectPoints(
	const PointSetSurface&   surface,
	const Eigen::Matrix3Xd&  positions,
	const ProjectionOptions& options  = {},
	const Progress&          progress = {});

// How far points moved by projection; those that were not projected do not count.
struct ProjectionMoves {
	Index  projected = 0;
	double rms = 0.0, largest = 0.0; // lengths; 0 if none was projected
};

// `unit`: how long a length of 1 is in the units wanted, such as PreparedCloud::diagonal for those of the model.
ProjectionMoves
movesOf(const ProjectedPoints& points, const Eigen::Matrix3Xd& from, double unit = 1.0);

// `count` places around each of `positions` (3 x M), itself first: evenly spread over the area of one control
// point, in the tangent plane there. Fixed; not yet on the surface.
Eigen::Matrix3Xd
scatterAround(const ControlPoints& control, const Eigen::Matrix3Xd& positions, Index count);

} // namespace curvature_lines
