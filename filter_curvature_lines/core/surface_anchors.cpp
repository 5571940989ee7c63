// Random subsets, thinning and the fits at the anchors.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_anchors.h"

#include <algorithm>
#include <cmath>

namespace curvature_lines {

namespace {

constexpr double anchorSpacing   = 0.18; // in radii
constexpr int    anchorIterations = 2;
constexpr Index  countedBalls    = 40;
constexpr Index  maxSubsets      = 64;

PointCloud block(const PointCloud& cloud, Index from, Index to)
{
	return {cloud.positions.middleCols(from, to - from), cloud.normals.middleCols(from, to - from)};
}

std::vector<Index>& scratchList()
{
	thread_local std::vector<Index> list;
	return list;
}

} // namespace

PointSubsets::PointSubsets(const PointSample& sample, double radius, Index cap) : m_whole(sample)
{
	const Index        n = sample.cloud.size();
	std::vector<Index> counts, found;
	for (Index i = 0; i < std::min(n, countedBalls); ++i) {
		sample.search.within(sample.cloud.positions.col(i), radius, found);
		counts.push_back(static_cast<Index>(found.size()));
	}
	std::nth_element(counts.begin(), counts.begin() + counts.size() / 2, counts.end());
	const Index subsets = std::clamp<Index>(counts[counts.size() / 2] / cap, 1, maxSubsets);
	if (subsets > 1)
		for (Index s = 0; s < subsets; ++s)
			m_subsets.push_back(std::make_unique<const PointSample>(block(
				sample.cloud,
				static_cast<Index>(std::int64_t(n) * s / subsets),
				static_cast<Index>(std::int64_t(n) * (s + 1) / subsets))));
}

std::vector<Index> thin(const PointSample& sample, double distance)
{
	const Index        n = sample.cloud.size();
	std::vector<char>  covered(n, 0);
	std::vector<Index> kept, found;
	for (Index i = 0; i < n; ++i) {
		if (covered[i])
			continue;
		kept.push_back(i);
		sample.search.within(sample.cloud.positions.col(i), distance, found);
		for (const Index j : found)
			covered[j] = 1;
	}
	return kept;
}

SurfaceElement surfaceAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	const HeightScale&     scale,
	int                    iterations)
{
	const PointSample&  sample = subsets[place];
	std::vector<Index>& near   = scratchList();
	LocalSurfaceFitter& fitter = LocalSurfaceFitter::ofThisThread();
	sample.search.within(position, scale.radius, near);
	SurfaceElement element = fitter.fitHeights(
		sample.cloud, near, position, gateNormal, scale.radius, scale.degree, iterations);
	if (!element.valid && scale.degree > 2)
		element =
			fitter.fitHeights(sample.cloud, near, position, gateNormal, scale.radius, 2, iterations);
	if (!element.valid) {
		const double wider = 1.5 * scale.radius;
		sample.search.within(position, wider, near);
		element = fitter.fitHeights(sample.cloud, near, position, gateNormal, wider, 2, iterations);
	}
	return element;
}

bool Zone::contains(const Eigen::Vector3d& position) const
{
	return !points || points->anyWithin(position, reach);
}

SurfaceAnchors::SurfaceAnchors(
	const PointSample&  sample,
	const PointSubsets& subsets,
	const HeightScale&  scale,
	const Zone&         zone,
	const Progress&     progress)
{
	const std::vector<Index>    kept = thin(sample, anchorSpacing * scale.radius);
	std::vector<SurfaceElement> elements(kept.size());
	parallelFor(static_cast<Index>(kept.size()), progress, [&](Index a) {
		if (!zone.contains(sample.cloud.positions.col(kept[a])))
			return;
		elements[a] = surfaceAt(
			subsets,
			a,
			sample.cloud.positions.col(kept[a]),
			sample.cloud.normals.col(kept[a]),
			scale,
			anchorIterations);
	});
	for (std::size_t a = 0; a < kept.size(); ++a)
		if (elements[a].valid)
			m_elements.push_back(elements[a]);
	m_origins.resize(3, m_elements.size());
	m_positions.resize(3, m_elements.size());
	for (std::size_t a = 0, valid = 0; a < kept.size(); ++a)
		if (elements[a].valid) {
			m_origins.col(valid)   = sample.cloud.positions.col(kept[a]);
			m_positions.col(valid) = elements[a].position;
			++valid;
		}
	m_search = std::make_unique<NeighborSearch>(m_positions);
}

SurfaceElement SurfaceAnchors::normalField(const SurfaceElement& start, double radius) const
{
	std::vector<Index>& near = scratchList();
	m_search->within(start.position, radius, near);
	return LocalSurfaceFitter::ofThisThread().fitNormals(m_elements, near, start, radius);
}

} // namespace curvature_lines
