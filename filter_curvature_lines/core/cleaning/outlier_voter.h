// One voter of the outlier rejection: a robust quadric and the part of the surface it was fitted to (in place of the
// operating region and its weights in A09 section 4.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "surface_patch.h"

namespace curvature_lines {

struct OutlierVoter {
	// How well the points the surface was fitted to surround a point.
	enum class Support { Inside, Rim, Outside };

	Index        centre    = 0; // a point of the cloud
	Index        neighbors = 0; // asked for
	SurfacePatch surface;       // invalid: no majority on one surface, and no vote
	double       spacing = 0.0; // of the points on the surface
	// Standard deviation of the heights of points over the surface here: the median of deviation() over the
	// voters around, so that one voter over an edge does not set its own limit. A length.
	double             heightDeviation = 0.0;
	bool               overEdge        = false; // its own deviation is too large for one surface
	std::vector<Index> ball; // all points it may judge, also those rejected before
	Eigen::Vector2d    supportCentre = Eigen::Vector2d::Zero();
	Eigen::Matrix2d    supportShape  = Eigen::Matrix2d::Identity(); // inverse covariance

	// Deviation of its points without what the fit took of it.
	double deviation() const;
	Support support(const SurfacePatch::Local& p) const;
	// Standard deviation of the height of a point on the surface above the fit.
	double heightError() const;
};

// What voters are fitted to.
struct VoterCloud {
	const Eigen::Matrix3Xd&    positions;
	const std::vector<double>& crowding; // distance to the 6th neighbour, of every point
	const std::vector<Index>&  rank;     // place in an order that does not depend on the input's
	const NeighborSearch&      all;
	const std::vector<Index>&  active;       // points not rejected
	const NeighborSearch&      activeSearch; // over them, in the same order
};

// The place among its neighbours whose distance VoterCloud::crowding holds.
constexpr Index crowdSize = 6;
// Spacing over that distance, of evenly spread points.
constexpr double spacingOfCrowd = 0.72;

void fitVoter(OutlierVoter& voter, const VoterCloud& cloud);

} // namespace curvature_lines
