// Cuts lines into the runs of vertices that are on no thin limb.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_creases.h"

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "scaffold_sites.h"
#include "sizing_field.h"

namespace curvature_lines {

namespace {

// Limbs thinner than so many spacings in radius are thin, and so many of the points nearest to the crease are asked.
constexpr double thinRadius = 2.5;
constexpr Index  asked      = 5;
constexpr Index  fewest     = 3; // vertices of a part that is kept

} // namespace

std::vector<FeatureLine> withoutThinLimbs(
	const std::vector<FeatureLine>& creases, const CloudIndex& index, const SizingField& sizing)
{
	std::vector<FeatureLine> kept;
	for (const FeatureLine& crease : creases) {
		const Index       count = static_cast<Index>(crease.points.cols());
		std::vector<char> thin(count);
		for (Index k = 0; k < count; ++k) {
			Index votes = 0;
			for (const Index i : index.search().nearest(crease.points.col(k), asked))
				votes += sizing.limb[i] < thinRadius * sizing.spacing[i];
			thin[k] = 2 * votes > asked;
		}
		if (std::count(thin.begin(), thin.end(), char(1)) == 0) {
			kept.push_back(crease);
			continue;
		}
		// A closed one begins on a limb, so that no part runs through its first vertex.
		Eigen::Matrix3Xd points = crease.points;
		if (crease.closed) {
			const auto first = std::find(thin.begin(), thin.end(), char(1)) - thin.begin();
			std::rotate(thin.begin(), thin.begin() + first, thin.end());
			points << crease.points.rightCols(count - first), crease.points.leftCols(first);
		}
		for (Index begin = 0; begin < count;) {
			if (thin[begin]) {
				++begin;
				continue;
			}
			const Index end = static_cast<Index>(
				std::find(thin.begin() + begin, thin.end(), char(1)) - thin.begin());
			if (end - begin >= fewest)
				kept.push_back({points.middleCols(begin, end - begin), false});
			begin = end;
		}
	}
	return kept;
}

} // namespace curvature_lines
