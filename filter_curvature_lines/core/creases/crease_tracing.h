// Crease points joined to curves: a moving least-squares curve through them, followed step by step.
// Internal to creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "crease_points.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

struct CreaseTrace {
	std::vector<CreasePoint> vertices; // in order, the tangents onward
	bool                     closed = false;
};

// The curves that points of creases lie on. The points must outlive it.
class CreaseTracing {
public:
	explicit CreaseTracing(const CreasePoints& points);

	// The curve near `guess` and along it; none where points are too few.
	std::optional<CreasePoint> curveAt(const CreasePoint& guess) const;

	// All curves that reach minAngle (radians), with vertices `step` apart.
	std::vector<CreaseTrace> traceAll(double step, double minAngle);

	double faceDeviation() const { return m_points.faceDeviation; }
	// Points further away than this belong to other curves.
	double width(const CreasePoint& at) const;

private:
	static Eigen::Matrix3Xd positionsOf(const std::vector<CreasePoint>& points);
	// Those of the points around that belong to the same crease, the right way round.
	std::vector<Index> sameCrease(const CreasePoint& at, double radius, double width) const;
	void follow(double step, CreaseTrace& trace) const;
	bool isTraced(const CreasePoint& at) const;
	void markTraced(const CreaseTrace& trace, double step);

	const CreasePoints& m_points;
	Eigen::Matrix3Xd    m_positions;
	NeighborSearch      m_search;
	std::vector<char>   m_traced; // per point: belongs to a curve already
};

} // namespace curvature_lines
