// Morton codes of the points, ties by their shuffled order.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "shuffled_order.h"

namespace curvature_lines {

namespace {

// Per coordinate: three of them fit into 32 bits, and 1024 cells along a side are enough for the cache.
constexpr int bits = 10;

std::uint32_t mortonCode(const Eigen::Vector3d& cell)
{
	std::uint32_t code = 0;
	for (int b = bits - 1; b >= 0; --b)
		for (int c = 0; c < 3; ++c)
			code = code << 1 | (static_cast<std::uint32_t>(cell[c]) >> b & 1u);
	return code;
}

} // namespace

SpatialOrder::SpatialOrder(const Eigen::Matrix3Xd& positions)
{
	const std::vector<Index> shuffled = shuffledOrder(positions);
	if (shuffled.empty())
		return;
	const Eigen::Vector3d corner = positions.rowwise().minCoeff();
	const double          extent = std::max(1e-30, (positions.colwise() - corner).maxCoeff());
	std::vector<std::tuple<std::uint32_t, Index, Index>> places; // code, rank, point
	for (Index r = 0; r < static_cast<Index>(shuffled.size()); ++r) {
		const Index i = shuffled[r];
		places.emplace_back(
			mortonCode((positions.col(i) - corner) * (((1 << bits) - 1) / extent)), r, i);
	}
	std::sort(places.begin(), places.end());
	for (const auto& [code, r, i] : places) {
		source.push_back(i);
		rank.push_back(r);
	}
}

std::vector<Index> SpatialOrder::sample(Index m) const
{
	std::vector<Index> places;
	for (std::size_t k = 0; k < rank.size(); ++k)
		if (rank[k] < m)
			places.push_back(static_cast<Index>(k));
	return places;
}

Eigen::Matrix3Xd SpatialOrder::arrange(const Eigen::Matrix3Xd& columns) const
{
	return columnsOf(columns, source);
}

Eigen::Matrix3Xd SpatialOrder::restore(const Eigen::Matrix3Xd& columns) const
{
	Eigen::Matrix3Xd restored(3, columns.cols());
	for (std::size_t k = 0; k < source.size(); ++k)
		restored.col(source[k]) = columns.col(k);
	return restored;
}

PreparedCloud inSpatialOrder(const PreparedCloud& prepared)
{
	const SpatialOrder order(prepared.cloud.positions);
	PreparedCloud      result = prepared;
	result.cloud = {order.arrange(prepared.cloud.positions), order.arrange(prepared.cloud.normals)};
	std::vector<Index> place(order.source.size());
	for (std::size_t k = 0; k < place.size(); ++k) {
		place[order.source[k]] = static_cast<Index>(k);
		result.source[k]       = prepared.source[order.source[k]];
	}
	for (Index& kept : result.representative)
		if (kept >= 0)
			kept = place[kept];
	return result;
}

} // namespace curvature_lines
