// The curvature a layer carries: K1, K2, PD1, PD2 and the curv_* attributes of its vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "layer_conversion.h"
#include "point_cloud.h"
#include "raw_curvatures.h"

namespace curvature_lines {

void writeCurvature(MeshModel& layer, const LayerPoints& points, const RawCurvatures& values);

// Whether K1, K2 and curv_confidence (PD1) on the layer are these values, as its precision holds them.
bool carriesCurvature(
	const MeshModel& layer, const LayerPoints& points, const RawCurvatures& values);
bool carriesDirections(
	const MeshModel& layer, const LayerPoints& points, const RawCurvatures& values);

// 3 x n: PD1 of the vertex that each kept point of the cloud was taken from, as it is.
Eigen::Matrix3Xd
readDirections(const MeshModel& layer, const LayerPoints& points, const PreparedCloud& prepared);

} // namespace curvature_lines
