// Rims and creases as lines of the mesh: crosses along them, whole numbers of the phase across them, and the
// corners that stay vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "phase_pins.h"
#include "rims.h"
#include "scaffold.h"
#include "surface_graph.h"

namespace curvature_lines {

struct FeatureAlignment {
	Eigen::Matrix3Xd  tangents; // 3 x V: zero where the field is free
	std::vector<char> meeting;  // V: aligned lines meet at a corner
	SurfaceFeatures   features;
};

// Creases always count; of a rim those sides between corners that run along a principal direction mostly, or
// where no direction is known. The guide is turned along them.
FeatureAlignment
alignWithFeatures(const Scaffold& scaffold, const std::vector<Rim>& rims, DirectionGuide& guide);

// The family across the tangent is pinned; both where lines meet.
PhasePins featurePins(const FeatureAlignment& alignment, const CrossField& field);

} // namespace curvature_lines
