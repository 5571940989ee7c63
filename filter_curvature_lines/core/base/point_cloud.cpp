// Preparation of raw clouds: every later stage may assume finite, distinct points in unit scale.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace curvature_lines {

namespace {

// A normal this short cannot be normalised without overflow.
constexpr double shortestNormal = 1e-150;

bool usableNormal(const Eigen::Vector3d& n)
{
	return n.allFinite() && n.cwiseAbs().maxCoeff() > shortestNormal;
}

void setUnitFrame(const Eigen::Matrix3Xd& positions, PreparedCloud& prepared)
{
	Eigen::Vector3d low  = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
	Eigen::Vector3d high = -low;
	for (const Index i : prepared.source) {
		low  = low.cwiseMin(positions.col(i));
		high = high.cwiseMax(positions.col(i));
	}
	prepared.center   = 0.5 * low + 0.5 * high;
	prepared.diagonal = (high - low).stableNorm();
	if (!std::isfinite(prepared.diagonal))
		throw InputError("The coordinates are too large to measure; scale the point cloud down.");
	if (!(prepared.diagonal > 0.0))
		throw InputError("All points are at the same place; a surface is needed.");
}

// Duplicates are judged after scaling, because points that differ far from the origin may coincide there.
void mergeDuplicates(
	const Eigen::Matrix3Xd& unitPositions, const Eigen::Matrix3Xd& normals, PreparedCloud& prepared)
{
	const Index        usable = static_cast<Index>(prepared.source.size());
	std::vector<Index> order(usable);
	for (Index i = 0; i < usable; ++i)
		order[i] = i;
	const auto less = [&](Index a, Index b) {
		for (int c = 0; c < 3; ++c)
			if (unitPositions(c, a) != unitPositions(c, b))
				return unitPositions(c, a) < unitPositions(c, b);
		return a < b;
	};
	std::sort(order.begin(), order.end(), less);

	std::vector<Index> first(usable); // the first duplicate of each usable point
	for (Index i = 0; i < usable; ++i) {
		const bool same = i > 0 && unitPositions.col(order[i]) == unitPositions.col(order[i - 1]);
		first[order[i]] = same ? first[order[i - 1]] : order[i];
	}

	Index              kept = 0;
	std::vector<Index> keptIndex(usable);
	Eigen::Matrix3Xd   normalSum = Eigen::Matrix3Xd::Zero(3, usable);
	std::vector<Index> source;
	for (Index i = 0; i < usable; ++i) {
		if (first[i] == i) {
			keptIndex[i] = kept++;
			source.push_back(prepared.source[i]);
		}
		keptIndex[i]                                = keptIndex[first[i]];
		prepared.representative[prepared.source[i]] = keptIndex[i];
		normalSum.col(keptIndex[i]) += normals.col(prepared.source[i]).stableNormalized();
	}
	prepared.duplicates = usable - kept;
	prepared.source     = std::move(source);

	prepared.cloud.positions.resize(3, kept);
	prepared.cloud.normals.resize(3, kept);
	for (Index i = 0; i < usable; ++i) {
		if (first[i] != i)
			continue;
		const Index     k   = keptIndex[i];
		Eigen::Vector3d sum = normalSum.col(k);
		// Two sheets that touch in a point cancel: the first one's normal is as good as any.
		if (sum.norm() < 1e-6)
			sum = normals.col(prepared.source[k]).stableNormalized();
		prepared.cloud.positions.col(k) = unitPositions.col(i);
		prepared.cloud.normals.col(k)   = sum.normalized();
	}
}

// Distance of the farthest point from the line through the two points farthest apart (nearly).
double thickness(const Eigen::Matrix3Xd& positions)
{
	Eigen::Index          far;
	const Eigen::Vector3d origin = positions.col(0);
	(positions.colwise() - origin).colwise().squaredNorm().maxCoeff(&far);
	const Eigen::Vector3d axis   = (positions.col(far) - origin).normalized();
	double                widest = 0.0;
	for (Eigen::Index i = 0; i < positions.cols(); ++i)
		widest = std::max(widest, axis.cross(positions.col(i) - origin).norm());
	return widest;
}

} // namespace

Eigen::Matrix3Xd columnsOf(const Eigen::Matrix3Xd& columns, const std::vector<Index>& which)
{
	Eigen::Matrix3Xd chosen(3, which.size());
	for (std::size_t k = 0; k < which.size(); ++k)
		chosen.col(k) = columns.col(which[k]);
	return chosen;
}

PointCloud columnsOf(const PointCloud& cloud, const std::vector<Index>& which)
{
	return {columnsOf(cloud.positions, which), columnsOf(cloud.normals, which)};
}

NeighborLists NeighborLists::fromRows(const std::vector<std::vector<Index>>& rows)
{
	std::size_t total = 0;
	for (const auto& row : rows)
		total += row.size();
	if (total > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
		throw std::length_error("neighbour lists exceed the index range");

	NeighborLists lists;
	lists.offsets.reserve(rows.size() + 1);
	lists.indices.reserve(total);
	for (const auto& row : rows) {
		lists.indices.insert(lists.indices.end(), row.begin(), row.end());
		lists.offsets.push_back(static_cast<Index>(lists.indices.size()));
	}
	return lists;
}

PreparedCloud
prepareCloud(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& normals, Index minPoints)
{
	if (positions.cols() != normals.cols())
		throw InputError("The point cloud has no normals; compute normals for point sets first.");

	PreparedCloud prepared;
	const Index   raw = static_cast<Index>(positions.cols());
	prepared.representative.assign(raw, -1);
	for (Index i = 0; i < raw; ++i) {
		if (!positions.col(i).allFinite())
			++prepared.nonFinite;
		else if (!usableNormal(normals.col(i)))
			++prepared.zeroNormals;
		else
			prepared.source.push_back(i);
	}
	const std::string required = std::to_string(std::max<Index>(minPoints, 1));
	if (prepared.zeroNormals > static_cast<Index>(prepared.source.size()))
		throw InputError("Most points have no normal; compute normals for point sets first.");
	if (prepared.source.empty())
		throw InputError("The layer has no usable points; at least " + required + " are needed.");

	setUnitFrame(positions, prepared);
	Eigen::Matrix3Xd unitPositions(3, prepared.source.size());
	for (std::size_t i = 0; i < prepared.source.size(); ++i)
		unitPositions.col(i) = prepared.toUnit(positions.col(prepared.source[i]));
	mergeDuplicates(unitPositions, normals, prepared);

	if (prepared.cloud.size() < minPoints)
		throw InputError(
			"Only " + std::to_string(prepared.cloud.size()) +
			" distinct points with normals remain; at least " + required + " are needed.");
	if (thickness(prepared.cloud.positions) <= 1e-9)
		throw InputError("All points lie on one line; a surface is needed.");
	return prepared;
}

} // namespace curvature_lines
