// Anchors: local surface estimates at a thinned set of points, the first stage of the adaptive curvature.
// Internal to adaptive_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "local_surface.h"

namespace curvature_lines {

// Points with their search tree. Stays where it is: the tree refers to the points.
struct PointSample {
	explicit PointSample(PointCloud points) : cloud(std::move(points)), search(cloud.positions) {}
	PointSample(const PointSample&) = delete;

	const PointCloud     cloud;
	const NeighborSearch search;
};

// A cloud cut into random subsets so that a ball of `radius` holds about `cap` points of each. Fits at
// neighbouring places take different subsets: none uses more than `cap` points, all use every point.
class PointSubsets {
public:
	// `sample` must be shuffled (shuffledOrder) and outlive the subsets.
	PointSubsets(const PointSample& sample, double radius, Index cap);

	const PointSample& operator[](Index place) const
	{
		return m_subsets.empty() ? m_whole : *m_subsets[place % m_subsets.size()];
	}

private:
	const PointSample&                              m_whole;
	std::vector<std::unique_ptr<const PointSample>> m_subsets; // empty: one subset, the whole
};

// Indices of points no two of which are nearer than `distance`, taken in order.
std::vector<Index> thin(const PointSample& sample, double distance);

struct HeightScale {
	double radius = 0.0; // length
	int    degree = 2;   // of the height polynomial: 2 or 4
};

// The surface at a point of a sample from a height polynomial; falls back to degree 2, then to a larger
// ball. `place` selects the subset.
SurfaceElement surfaceAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	const HeightScale&     scale,
	int                    iterations);

// The points within `reach` of given ones.
struct Zone {
	const NeighborSearch* points = nullptr; // nullptr: everywhere
	double                reach  = 0.0;

	bool contains(const Eigen::Vector3d& position) const;
};

class SurfaceAnchors {
public:
	SurfaceAnchors(
		const PointSample&  sample,
		const PointSubsets& subsets,
		const HeightScale&  scale,
		const Zone&         zone     = {},
		const Progress&     progress = {});

	Index size() const { return static_cast<Index>(m_elements.size()); }
	const std::vector<SurfaceElement>& elements() const { return m_elements; }
	const Eigen::Matrix3Xd&            origins() const { return m_origins; }

	// Second stage: `start` with the shape operator and the normal of the normal field within `radius`.
	SurfaceElement normalField(const SurfaceElement& start, double radius) const;

private:
	std::vector<SurfaceElement>     m_elements;
	Eigen::Matrix3Xd                m_origins, m_positions;
	std::unique_ptr<NeighborSearch> m_search; // over m_positions
};

} // namespace curvature_lines
