// Ranks by distance to the centroid, scattered by a hash.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "shuffled_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

// A floating-point sum would depend on the order of the points. Unit-frame coordinates are below 1, so
// 2^23 points sum up exactly; more share a coarser grid.
Eigen::Vector3d exactCentroid(const Eigen::Matrix3Xd& positions)
{
	const Eigen::Index n     = positions.cols();
	const double       scale = n < (1 << 23) ? 0x1p39 : 0x1p30;
	Eigen::Vector3d    centroid;
	for (int c = 0; c < 3; ++c) {
		std::int64_t sum = 0;
		for (Eigen::Index i = 0; i < n; ++i)
			sum += std::llround(positions(c, i) * scale);
		centroid[c] = double(sum) / (scale * double(n));
	}
	return centroid;
}

// Every step can be undone, so different ranks keep different keys.
std::uint32_t scatter(std::uint32_t rank)
{
	std::uint32_t h = rank * 2654435761u;
	h ^= h >> 16;
	h *= 0x85ebca6bu;
	h ^= h >> 13;
	h *= 0xc2b2ae35u;
	return h ^ (h >> 16);
}

} // namespace

std::vector<Index> shuffledOrder(const Eigen::Matrix3Xd& positions)
{
	const auto         n = static_cast<Index>(positions.cols());
	std::vector<Index> order(n);
	std::iota(order.begin(), order.end(), 0);
	if (n == 0)
		return order;
	const Eigen::VectorXd distance =
		(positions.colwise() - exactCentroid(positions)).colwise().squaredNorm();
	std::sort(order.begin(), order.end(), [&](Index a, Index b) {
		if (distance[a] != distance[b])
			return distance[a] < distance[b];
		for (int c = 0; c < 3; ++c)
			if (positions(c, a) != positions(c, b))
				return positions(c, a) < positions(c, b);
		return a < b;
	});
	std::vector<std::pair<std::uint32_t, Index>> scattered(n);
	for (Index rank = 0; rank < n; ++rank)
		scattered[rank] = {scatter(rank), order[rank]};
	std::sort(scattered.begin(), scattered.end());
	std::transform(
		scattered.begin(), scattered.end(), order.begin(), [](const auto& s) { return s.second; });
	return order;
}

} // namespace curvature_lines
