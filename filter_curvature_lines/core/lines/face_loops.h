// Which loops of an embedded graph bound a face, and which run around a hole or along a rim (A09
// section 6 makes every loop a face).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {

enum class LoopKind {
	Face,    // turns about once and there are points of the cloud inside
	Rim,     // turns backwards: the outside of an open piece
	Hole,    // no points inside: an opening, or the end of a tube
	Tangled, // turns more than twice: bounds no disk, a crossing is missing
};

// Total turning of a loop in its tangent planes, as a multiple of 2 pi, of exterior corners and
// bends along the edges. Gauss-Bonnet: 1 for a disk, less its share of the Gaussian curvature.
double turningNumber(const HalfEdgeGraph& graph, const std::vector<Index>& loop);

class LoopClassifier {
public:
	LoopClassifier(const PointCloud& cloud, const VoronoiCells& cells, const HalfEdgeGraph& graph);
	LoopKind operator()(const std::vector<Index>& loop) const;

private:
	bool isCovered(const std::vector<Index>& loop) const;
	bool isPointAbove(
		const Eigen::Vector3d& sample,
		const Eigen::Vector3d& normal,
		double                 size,
		Index&                 site) const;

	const PointCloud&    m_cloud;
	const VoronoiCells&  m_cells;
	const HalfEdgeGraph& m_graph;
};

} // namespace curvature_lines
