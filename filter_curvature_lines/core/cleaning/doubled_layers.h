// Scans that were registered badly: one surface that the cloud has twice, as two layers that face the same way.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Share of the points, 0..1, around which the surface is there twice; of a sample of 500. `given`: the points as they came;
// `denoised`: the same after denoising. Two layers less than about a spacing apart have become one, and the heights of the
// given points above it are of two kinds; that is told from noise where the layers are five deviations of the noise apart
// and neither has less than a third of the points. Layers farther apart, up to four spacings of the whole cloud, are still two, and a point sees
// others of the same side straight above or below, as on no true surface: between two sheets that face the same way there is
// one that faces the other way. Rounded coordinates make layers, too, and do not count where they can be told
// (coordinate_steps.h).
double
doubledShare(const CloudIndex& given, const PointCloud& denoised, const Progress& progress = {});

} // namespace curvature_lines
