// Interleaved bits of the coordinates as sort keys.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial_order.h"

#include <algorithm>

namespace curvature_lines {

namespace {

constexpr int    bits  = 21;
constexpr double cells = double((1u << bits) - 1);

// The 21 lower bits, two zeros between each.
std::uint64_t spread(std::uint64_t b)
{
	b = (b | b << 32) & 0x001f00000000ffff;
	b = (b | b << 16) & 0x001f0000ff0000ff;
	b = (b | b << 8) & 0x100f00f00f00f00f;
	b = (b | b << 4) & 0x10c30c30c30c30c3;
	return (b | b << 2) & 0x1249249249249249;
}

} // namespace

std::vector<Index> spatialOrder(const Eigen::Matrix3Xd& positions)
{
	const auto         n = static_cast<Index>(positions.cols());
	std::vector<Index> order(n);
	if (n == 0)
		return order;
	const Eigen::Vector3d low  = positions.rowwise().minCoeff();
	const double          size = (positions.rowwise().maxCoeff() - low).maxCoeff();
	const double          unit = size > 0.0 ? cells / size : 0.0;
	std::vector<std::pair<std::uint64_t, Index>> keys(n);
	for (Index i = 0; i < n; ++i) {
		const Eigen::Vector3d cell = (positions.col(i) - low) * unit;
		keys[i] = {
			spread(std::uint64_t(cell.x())) << 2 | spread(std::uint64_t(cell.y())) << 1 |
				spread(std::uint64_t(cell.z())),
			i};
	}
	std::sort(keys.begin(), keys.end());
	std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
	return order;
}

} // namespace curvature_lines
