// The spacing that as many points have as are wanted, by bisection, and the shuffled order as chance.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "even_sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

std::vector<Index> evenSample(const CloudIndex& index, Index most, const Progress& progress)
{
	constexpr int      steps = 40;
	const Index        n     = index.size();
	std::vector<Index> kept;
	if (n <= most) {
		kept.resize(n);
		std::iota(kept.begin(), kept.end(), 0);
		return kept;
	}
	const SpatialOrder&        order   = index.order();
	const std::vector<double>& spacing = index.spacing(progress);

	const auto share = [&](Index place, double wanted) {
		const double ratio = spacing[place] / wanted;
		return std::min(1.0, ratio * ratio);
	};
	const auto [least, largest] = std::minmax_element(spacing.begin(), spacing.end());
	double low = *least, high = *largest * std::sqrt(double(n) / double(std::max<Index>(most, 1)));
	for (int k = 0; k < steps; ++k) {
		const double middle = std::sqrt(low * high);
		double       sum    = 0.0;
		for (Index place = 0; place < n; ++place)
			sum += share(place, middle);
		(sum > most ? low : high) = middle;
	}
	for (Index place = 0; place < n; ++place)
		if (order.rank[place] < n * share(place, high))
			kept.push_back(order.source[place]);
	std::sort(kept.begin(), kept.end());
	return kept;
}

} // namespace curvature_lines
