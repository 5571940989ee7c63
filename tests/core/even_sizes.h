// Sizes of a quad mesh that are the same everywhere.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "cloud_index.h"
#include "sizing_field.h"

namespace curvature_lines::test {

// For about so many vertices, whatever the shape asks for.
inline SizingField evenSizes(const CloudIndex& index, double targetVertices)
{
	SizingField sizing;
	sizing.spacing =
		Eigen::Map<const Eigen::VectorXd>(index.minimum().spacing.data(), index.size());
	sizing.feature.setConstant(index.size(), INFINITY);
	sizing.limb.setConstant(index.size(), INFINITY);
	sizing.expected = targetVertices;
	// Area of a random point over the square of its mean distance to six neighbours, the nearest in each slice.
	sizing.body = std::sqrt(0.667 * sizing.spacing.squaredNorm() / targetVertices);
	return sizing;
}

} // namespace curvature_lines::test
