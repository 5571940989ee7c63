// Flying (mixed) pixels of range sensors: points measured between two surfaces where the depth jumps from one to the
// other (Tang, Huber, Akinci 2007: mixed pixels of laser scanners).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "outlier_voter.h"
#include "progress.h"

namespace curvature_lines {

// One flag per point: it is on a sheet that is much sparser than the surfaces at both of its ends, and no wider than a
// sheet of one pixel per row of the sensor can be. `cloud.active` is not looked at. Does not depend on the order of points.
std::vector<char> findFlyingPixels(const VoterCloud& cloud, const Progress& progress = {});

// One flag per point: of the candidates, those that stand alone between two surfaces of a regular scan. Their second
// nearest point is `isolation` times as far as that of their neighbours (the nearest is often another mixed pixel). They are
// too few per sheet for findFlyingPixels.
std::vector<char> findLoneMixedPixels(
	const VoterCloud&        cloud,
	const std::vector<char>& candidates,
	double                   isolation,
	const Progress&          progress = {});

} // namespace curvature_lines
