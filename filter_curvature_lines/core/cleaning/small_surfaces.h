// Small surfaces through the neighbours of one point: whether a part of the shape that is narrower than the patches of
// the vote runs on through the point.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "outlier_voter.h"
#include "point_cloud.h"

namespace curvature_lines {

// A surface that was fitted to neighbours of a point without the point, and passes through it.
struct PassingSurface {
	Index              neighbors = 0; // it was fitted to
	std::vector<Index> members;       // those of them that lie on it, the nearest first
	// Members that the surface joins to the point: halfway between the two there is surface, too. Those on another sheet of
	// it, and points beyond a step, are not.
	std::vector<Index> joined;
	double reach   = 0.0; // a joined member as near as this is next to the point; a length
	double spacing = 0.0; // of the neighbours, a length
};

struct SmallSurfaceOptions {
	double noise       = 0.0; // standard deviation of the distances from a surface, in spacings
	double sensitivity = 3.5; // so many of them a point may be away, as in OutlierOptions
	// Implicit quadrics as well. They follow tips, rods and thin rims, but are so flexible that in noise one of them soon
	// passes through a point beside the surface.
	bool implicit = false;
};

// Surfaces through some 10 to 20 neighbours of point i that pass through it: quadrics of heights over several planes, and
// implicit quadrics.
std::vector<PassingSurface>
surfacesThrough(const VoterCloud& cloud, Index i, const SmallSurfaceOptions& options);

// Standard deviation of the heights of the sixteen points nearest to point i, itself among them, over a least-squares
// quadric; a length. 0 where the cloud has too few points.
double smallDeviation(const VoterCloud& cloud, Index i);

} // namespace curvature_lines
