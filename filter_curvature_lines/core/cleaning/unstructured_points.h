// Hair, grass, foliage: points that are on no surface which the cloud could resolve.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Per point of the cloud, 1 where its neighbourhoods are as thick as they are wide at every size, so that no quadric is near
// its points: of 16 to 1500 points, or of the two smallest sizes at which most of the cloud is a surface. Points whose normals
// oppose the point's are of another sheet. A point goes with most of its neighbours, so that tips and rims, where a few
// points look like hair, stay. A surface with noise of two spacings is one: a neighbourhood of some hundred points shows it.
std::vector<char> findUnstructured(const CloudIndex& index, const Progress& progress = {});

// Share of the points that findUnstructured() would say 1 of and that are not `rejected` (N, or empty: none is), 0..1; from a
// sample of 200, without asking their neighbours, so that some percent of a coarse shape may be counted.
double unstructuredShare(
	const CloudIndex& index, const std::vector<char>& rejected = {}, const Progress& progress = {});

} // namespace curvature_lines
