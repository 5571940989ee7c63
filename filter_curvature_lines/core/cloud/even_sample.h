// Fewer points of a cloud that has more than a mesh of it can use.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Indices, ascending, of about `most` points at most: where the cloud is denser than the sample is to be, a random
// part of it, elsewhere all. Random, because picking points by their distances would favour those that noise moved
// out of the surface. The same sample in whatever order the points come.
std::vector<Index> evenSample(const CloudIndex& index, Index most, const Progress& progress = {});

} // namespace curvature_lines
