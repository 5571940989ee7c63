// Height polynomials at a thinned set of points: what anchors are made from. Internal to adaptive_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"

namespace curvature_lines {

// Whether a point this far off the surface fitted around it is no sample of it.
bool isOutlier(const SurfaceElement& element, const Eigen::Vector3d& position, double radius);

struct HeightScale {
	double radius = 0.0; // length
	int    degree = 2;   // of the height polynomial: 2 or 4
};

// The height polynomials wanted in a ball.
struct Degrees {
	bool quadric = false;
	bool quartic = false;

	static Degrees only(int degree) { return {degree == 2, degree == 4}; }
};

struct HeightFits {
	SurfaceElement quadric, quartic; // invalid if not wanted or impossible

	const SurfaceElement& of(int degree) const { return degree == 2 ? quadric : quartic; }
};

// The surface at a point of a sample from height polynomials; a quartic falls back to the quadric, that to a
// larger ball. `place` selects the subset.
HeightFits surfacesAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	double                 radius,
	Degrees                degrees,
	int                    iterations);

// Only that of one degree.
SurfaceElement surfaceAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	const HeightScale&     scale,
	int                    iterations);

// The points within `reach` of given ones.
struct Vicinity {
	const NeighborSearch* points = nullptr; // nullptr: everywhere
	double                reach  = 0.0;

	bool contains(const Eigen::Vector3d& position) const;
};

// Height fits at a thinned set of points, in spatial order.
struct AnchorFits {
	Eigen::Matrix3Xd points; // what was fitted at
	// of the points in the order of thinning, which is random in space
	std::vector<Index>      places;
	std::vector<HeightFits> fits; // one per point; outliers have none
	bool                    hasOutliers = false;
};

// How dense anchors are, and how many of them say where the faces of an edge are. A sketch is enough to judge a
// scale by, not to build on.
enum class AnchorDetail { Full, Sketch };

AnchorFits fitAnchors(
	const PointSample&  sample,
	const PointSubsets& subsets,
	double              radius,
	Degrees             degrees,
	AnchorDetail        detail   = AnchorDetail::Full,
	const Vicinity&     vicinity = {});

} // namespace curvature_lines
