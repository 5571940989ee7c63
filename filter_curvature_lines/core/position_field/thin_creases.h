// Creases that points cannot tell from the roundness of a thin limb: there the surface turns as fast as at a crease.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "scaffold_sites.h"
#include "sizing_field.h"

namespace curvature_lines {

// The parts of the creases that do not run along limbs of a radius below a few spacings.
std::vector<FeatureLine> withoutThinLimbs(
	const std::vector<FeatureLine>& creases, const CloudIndex& index, const SizingField& sizing);

} // namespace curvature_lines
