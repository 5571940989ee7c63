// Rims where the surface really ends. The front stops at the outermost points; the rim they were drawn from
// lies a little further out, by how densely they lie, and with noise further in.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "rims.h"
#include "scaffold.h"

namespace curvature_lines {

// Moves the vertices of the rims, corners to where their sides meet; corners at which these do not turn are
// none. `normals` are those of the vertices; `noise` that of the cloud's positions (standard deviation, a
// length): it carries points beyond the rim.
void fitRims(
	std::vector<Rim>&       rims,
	const PointCloud&       cloud,
	const Eigen::Matrix3Xd& normals,
	double                  noise,
	Scaffold&               scaffold);

} // namespace curvature_lines
