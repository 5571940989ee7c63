// Rejected points between which a surface goes on that has few points there: the sole of a foot, a flat end. Patches of
// the vote hold hundreds of points of the dense parts beside them and know nothing of such a part.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "outlier_voter.h"
#include "progress.h"

namespace curvature_lines {

// Takes points back that close a gap of the accepted points: in the plane of a point's own normal accepted points, or others
// that are taken back, lie all around it, farther off than the accepted ones are from each other, near this plane, on the
// same side of the surface. An outlier has the surface below it, or normals across its own around it.
// `normals`: 3 x N, unit; a point without one (zero) stays as it is; `excluded`: points that stay rejected whatever is around
// them. Does not depend on the order of the points.
void restoreSparseSurfaces(
	const VoterCloud&        cloud,
	const Eigen::Matrix3Xd&  normals,
	const std::vector<char>& excluded,
	std::vector<char>&       rejected,
	const Progress&          progress = {});

} // namespace curvature_lines
