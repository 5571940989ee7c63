// Umbilic points and regions, and directions for them (A09 section 5.1, "umbilical regions").
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

struct UmbilicOptions {
	// k_small / k_large (signed, by magnitude) above which a point is umbilic
	double ratio  = 0.95;
	double errors = 2.5; // also umbilic when |k1 - k2| is below this many standard errors
	// regions of at least this many points get PCA directions (A09: "more than three")
	Index minRegion = 4;
	bool  smoothed  = false; // the field's directions are: they lead where they can, see below
};

struct UmbilicRegions {
	std::vector<char>  umbilic; // N
	std::vector<Index> region;  // N, region id or -1
	Index              regions = 0;
	// PCA directions of every region point (projected eigenvectors of the region and its
	// non-umbilic neighbours); other points keep the field's.
	Eigen::Matrix3Xd d1, d2;
	// Where the projected eigenvector nearly vanishes (poles of a sphere) there is no direction.
	std::vector<char> singular; // N
};

// Same sign and ratio above options.ratio, or flat (both curvatures below 0.02 / (3 h) + 2 errors),
// or statistically equal. Opposite signs are never umbilic by ratio. The flag is median-filtered
// over the minimum neighbourhood. Where estimates are uncertain, as at rims, the statistical test makes regions of
// what only noise hides, and their axes are arbitrary. Smoothed directions come from the points around and know
// better: regions that they go on into from most sides, without a singular point, are none.
UmbilicRegions findUmbilics(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicOptions&       options = {});

} // namespace curvature_lines
