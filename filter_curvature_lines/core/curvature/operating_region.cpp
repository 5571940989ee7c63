// Collects the points and the variation samples of an operating region (A09 section 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "operating_region.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "irls.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

// Of the squared spacing: keeps the geometric weight of nearly coincident points finite.
constexpr double closestPairShare = 1e-3;

// splitmix64 of the pair's ranks by distance: which pairs are left out depends on no order and no thread.
std::uint64_t pairHash(std::uint64_t a, std::uint64_t b)
{
	std::uint64_t z = (a << 32 | b) + 0x9e3779b97f4a7c15ull;
	z               = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
	z               = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
	return z ^ (z >> 31);
}

void addPair(const OperatingRegion& region, Index a, Index b, VariationSamples& samples)
{
	samples.add(
		a,
		b,
		region.positions[b] - region.positions[a],
		region.normals[b] - region.normals[a],
		region.geometricWeight(a, b));
}

} // namespace

void OperatingRegion::collect(
	const PointCloud&      cloud,
	const NeighborSearch&  search,
	Index                  i,
	const Eigen::Vector3d& normal,
	double                 localSpacing,
	double                 regionScale,
	Index                  minPoints,
	Index                  maxPoints)
{
	const Eigen::Vector3d center = cloud.positions.col(i);
	radius                       = regionScale * localSpacing;
	std::vector<Index> found     = search.within(center, radius);
	// p_i is among them
	const bool sparse = static_cast<Index>(found.size()) <= minPoints;
	if (sparse)
		found = search.within(center, 2.0 * radius);
	found.erase(std::remove(found.begin(), found.end(), i), found.end());
	const Index limit = sparse ? minPoints : maxPoints;
	const bool  cut   = limit > 0 && static_cast<Index>(found.size()) > limit;
	if (cut)
		found.resize(limit);
	if (!found.empty() && (sparse || cut)) {
		const double reach = (cloud.positions.col(found.back()) - center).norm();
		radius             = std::max(reach, sparse ? radius : 1e-3 * radius);
	}

	frame   = TangentFrame(normal);
	spacing = localSpacing / radius;
	points.assign(1, i);
	points.insert(points.end(), found.begin(), found.end());
	positions.clear();
	normals.clear();
	heights.clear();
	squaredDistances.clear();
	for (const Index j : points) {
		const Eigen::Vector3d d = (cloud.positions.col(j) - center) / radius;
		const Eigen::Vector3d n = j == i ? normal : Eigen::Vector3d(cloud.normals.col(j));
		positions.push_back(frame.toPlane(d));
		heights.push_back(d.dot(frame.n));
		normals.emplace_back(n.dot(frame.u), n.dot(frame.v), n.dot(frame.n));
		squaredDistances.push_back(d.squaredNorm());
	}
}

double OperatingRegion::geometricWeight(Index a, Index b) const
{
	const double meanSquare = 0.5 * (squaredDistances[a] + squaredDistances[b]);
	return 1.0 / std::max(meanSquare, closestPairShare * spacing * spacing);
}

void collectCentrePairs(const OperatingRegion& region, VariationSamples& samples)
{
	samples.clear();
	for (Index j = 1; j < region.size(); ++j)
		addPair(region, 0, j, samples);
}

void collectPairs(
	const OperatingRegion&    region,
	const std::vector<Index>& members,
	Index                     maxPairs,
	VariationSamples&         samples)
{
	samples.clear();
	const std::size_t n     = members.size();
	const double      total = 0.5 * double(n) * (double(n) - 1.0);
	const double      share = total > maxPairs ? maxPairs / total : 1.0;
	for (std::size_t a = 0; a < n; ++a)
		for (std::size_t b = a + 1; b < n; ++b)
			if (share == 1.0 || double(pairHash(a, b) >> 11) * 0x1p-53 < share)
				addPair(region, members[a], members[b], samples);
}

} // namespace curvature_lines
