// Voronoi cells of the cloud as the dual of CGAL's exact 3-D Delaunay triangulation (A09 section 5.1):
// which cell a point lies in, and where a segment passes from cell to cell.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

class VoronoiCells {
public:
	// One wall between two cells, crossed by a segment at parameter t in [0, 1].
	struct Crossing {
		double t;
		Index  from, to;
	};

	// Only neighbours are kept. Coplanar sites are fine. Throws InputError when they span less than a plane.
	explicit VoronoiCells(const Eigen::Matrix3Xd& sites, const Progress& progress = {});

	Index size() const { return m_neighbors.size(); }
	// Delaunay, by index
	NeighborLists::Row neighbors(Index site) const { return m_neighbors[site]; }
	const Eigen::Vector3d site(Index i) const { return m_sites.col(i); }

	// The cell of `point`, by greedy descent from `start` (exact on a Delaunay graph; ties to the lower index).
	Index locate(const Eigen::Vector3d& point, Index start) const;

	// Walls crossed on the way from a (in cell `start`) to b, by increasing t, each to a cell closer to b.
	// Ends in locate(b). A point shared by more than two cells gives several crossings of equal t.
	std::vector<Crossing>
	walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Index start) const;

private:
	double distance2(const Eigen::Vector3d& point, Index i) const
	{
		return (m_sites.col(i) - point).squaredNorm();
	}
	Index lowestTie(const Eigen::Vector3d& point, Index cell) const;

	Eigen::Matrix3Xd m_sites;
	NeighborLists    m_neighbors;
};

// Mean distance from a site to its six nearest neighbours: the spacing of the cloud there.
double siteSpacing(const VoronoiCells& cells, Index site);

} // namespace curvature_lines
