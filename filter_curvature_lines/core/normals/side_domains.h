// Open surfaces: pieces with one side are turned so that they agree with each other, and what no winding number
// decides goes to a direction of the user's.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include <Eigen/Core>

#include "dipole_sums.h"
#include "neighborhoods.h"
#include "progress.h"

namespace curvature_lines {

// Whether two points, d apart, with these unit normals lie on one smooth piece of surface, whichever sides the normals are of.
bool areOnOnePiece(const Eigen::Vector3d& d, const Eigen::Vector3d& a, const Eigen::Vector3d& b);

struct SideDomains {
	Eigen::Matrix3Xd normals;    // 3 x N
	double undecidedShare = 0.0; // of points on pieces that are as good inside out (open surfaces)
};

// positions, normals: 3 x N, normals unit. width: of the winding kernel, a length. preferred: per point, where its
// front should look if the winding number decides nothing; none: it is left as it is.
SideDomains alignSideDomains(
	const Eigen::Matrix3Xd&                      positions,
	Eigen::Matrix3Xd                             normals,
	const NeighborSearch&                        search,
	const DipoleSums&                            sums,
	double                                       width,
	const std::function<Eigen::Vector3d(Index)>& preferred,
	const Progress&                              progress);

} // namespace curvature_lines
