// Points that are stored again, with or without a small error: a scan merged with a copy, or with a part, of itself.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Copies of a point have its noise as well: they are one observation, and whoever predicts a point without itself must
// not predict it from its copy.
struct NearDuplicates {
	// N: which points are one, numbered from 0 on; in the order of CloudIndex::shuffled(), so that neither the order of
	// the cloud nor the number of threads matters.
	std::vector<Index> group;
	Index              groups = 0; // N where there are no duplicates
	double             reach =
		0.0; // within which points were taken for one, in local spacings; 0: there are none
};

// Looks for pairs at a distance at which the cloud has many, while it has hardly any at up to twice that distance: other
// points of a surface, random or regular or on lines, are farther off the more there are of them. At most 0.3 spacings.
// Points whose normals oppose each other are of two sheets. Fewer than a twentieth of the points in pairs are left alone.
NearDuplicates nearDuplicates(const CloudIndex& index, const Progress& progress = {});

// One point per group, in the order of their numbers: mean position, unit mean normal.
PointCloud meanPoints(const CloudIndex& index, const NearDuplicates& duplicates);

// The points of a cloud whose means have moved from `before` to `after`: in the tangent planes there, with their places
// around the means kept.
PointCloud placedAroundMeans(
	const PointCloud&     cloud,
	const NearDuplicates& duplicates,
	const PointCloud&     before,
	const PointCloud&     after);

} // namespace curvature_lines
