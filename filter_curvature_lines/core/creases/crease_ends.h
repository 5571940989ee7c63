// Ends of traced creases, and traces joined over gaps. Internal to creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "crease_points.h"
#include "crease_tracing.h"
#include "point_cloud.h"

namespace curvature_lines {

// By experiment (benchmarks/creases.py); in spacings.
constexpr double spacingsBehind = 3.0; // that a trace may run on beyond the corner it ends in
constexpr double shortestLoop   = 8.0; // a shorter closed curve is none

// One end of a trace, the tangent outward.
struct CreaseEnd {
	Index       trace;
	bool        atBack;
	CreasePoint vertex;
};

// Front and back of every open trace in turn.
std::vector<CreaseEnd> endsOf(const std::vector<CreaseTrace>& traces);
Eigen::Matrix3Xd positionsOf(const std::vector<CreaseEnd>& ends);

// Length over which points may be missing at the end of a crease.
double reachOf(const CreasePoint& end, double deviation);

double lengthInSpacings(const CreaseTrace& trace);

// Traces, with vertices `step` apart, that are parts of one crease become one.
void joinGaps(const CreaseTracing& tracing, double step, std::vector<CreaseTrace>& traces);

} // namespace curvature_lines
