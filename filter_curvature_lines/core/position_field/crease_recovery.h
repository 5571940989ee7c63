// Creases that the advancing front passed over: points on them stick out of a cloud that denoising rounded,
// and the front closes below. They are put in, and edges that cross a crease are flipped.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// `triangles` (two-manifold) get the points at the ends of wanted edges, and these as far as flips lead there.
void recoverCreaseEdges(
	const Eigen::Matrix3Xd&                     points,
	const std::vector<std::pair<Index, Index>>& wanted,
	std::vector<Triangle>&                      triangles);

} // namespace curvature_lines
