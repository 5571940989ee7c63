// Clouds as the adaptive estimate wants them: shuffled, in the frame in which the surface's diagonal is 1.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "shuffled_order.h"

namespace curvature_lines::test {

// `noise`: a share of the diagonal.
inline PointCloud shuffledCloud(const std::string& surface, int points, double noise)
{
	samples::SampleRequest request;
	request.surface                  = surface;
	request.points                   = points;
	request.noise                    = noise;
	request.seed                     = 4;
	const samples::SampleCloud cloud = samples::generate(request);
	const std::vector<Index>   order = shuffledOrder(cloud.positions);
	return {
		cloud.positions(Eigen::all, order) / samples::surface(surface).diagonal(),
		cloud.normals(Eigen::all, order)};
}

} // namespace curvature_lines::test
