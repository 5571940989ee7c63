// What every stage needs to know about a cloud, computed once for one set of positions: its canonical orders, one
// search tree, spacing, the side of the surface, minimum neighbourhoods.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

// An immutable handle, cheap to copy: copies share the cloud and all that was computed of it. Everything is computed
// when it is first asked for, whatever thread asks; `progress` hears of it then, and a cancellation leaves it undone.
// References stay valid as long as one copy of the handle lives. One who moves points makes a new index.
class CloudIndex {
public:
	// Nothing is computed yet, so that a cloud may stand where an index is asked for.
	CloudIndex(PointCloud cloud = {}, const MinimumNeighborhoodOptions& options = {});

	const PointCloud& cloud() const { return *m_cloud; }
	Index size() const { return cloud().size(); }
	// These points of the cloud alone.
	CloudIndex part(const std::vector<Index>& which) const;
	// A cloud of other positions, 3 x N, with nothing computed yet but the same options.
	CloudIndex moved(Eigen::Matrix3Xd positions, Eigen::Matrix3Xd normals) const;
	// The same points with corrected normals (3 x N, unit). Shares all the rest: neighbourhoods and gate normals stay
	// those the first normals led to.
	CloudIndex withNormals(Eigen::Matrix3Xd normals) const;

	// The points along a Morton curve, and their ranks in a fixed random order (shuffled_order.h). Neither depends on
	// the order of the cloud.
	const SpatialOrder& order() const;
	// N: the point at each place of the random order.
	const std::vector<Index>& shuffled() const;
	// 3 x N: positions in the order of the curve.
	const Eigen::Matrix3Xd& arrangedPositions() const;

	// One tree, three ways to name what it finds: points of the cloud, places in order(), places in shuffled().
	const NeighborSearch& search() const;
	const NeighborSearch& arrangedSearch() const;
	const NeighborSearch& shuffledSearch() const;

	// N, a length: side of the square that holds one point, smooth (localSpacing()); at the places of order().
	const std::vector<double>& spacing(const Progress& progress = {}) const;
	// 3 x N, unit: normals that tell the side of the surface and no more (gateNormals()).
	const Eigen::Matrix3Xd& gateNormals(const Progress& progress = {}) const;
	// Six-slice neighbourhoods with their boundary flags, by the options the index was made with.
	const MinimumNeighborhoods& minimum(const Progress& progress = {}) const;

private:
	struct State;
	std::shared_ptr<const PointCloud> m_cloud;
	std::shared_ptr<const State>      m_state;
};

} // namespace curvature_lines
