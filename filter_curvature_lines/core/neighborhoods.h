// Nearest neighbours and the six-slice minimum neighbourhood with its boundary flag
// (A09 section 3 and fig. 4a; R07 fig. 6a).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "box_tree.h"
#include "progress.h"

namespace curvature_lines {

// Neighbour search among fixed positions, which must outlive it.
class NeighborSearch {
public:
	explicit NeighborSearch(const Eigen::Matrix3Xd& positions) : m_positions(&positions), m_tree(positions) {}

	// Indices of the k nearest points, by increasing distance, ties by index. Fewer if the cloud is smaller.
	std::vector<Index> nearest(const Eigen::Vector3d& query, Index k) const;
	// All points within radius, by increasing distance, ties by index.
	std::vector<Index> within(const Eigen::Vector3d& query, double radius) const;
	// The same in spatial order, into storage the caller keeps: for large balls.
	void within(const Eigen::Vector3d& query, double radius, std::vector<Index>& found) const
	{
		m_tree.within(query, radius, found);
	}
	bool anyWithin(const Eigen::Vector3d& query, double radius) const { return m_tree.anyWithin(query, radius); }
	// All indices so that neighbours mostly follow each other (spatial_order.h).
	const std::vector<Index>& spatialOrder() const { return m_tree.spatialOrder(); }

private:
	const Eigen::Matrix3Xd* m_positions;
	BoxTree                 m_tree;
};

struct MinimumNeighborhoodOptions {
	// A slice is empty when no point in it is nearer than this many median spacings; the median is that of
	// the cloud or of the candidates, whichever is larger: a sparse part of a scan is not a boundary.
	double boundaryThreshold = 2.5;
	// Candidates looked at per point; those whose normal opposes the point's are on another sheet, unless
	// nearly all do, because then it is the point's normal that is wrong.
	Index candidates = 40;
};

struct MinimumNeighborhoods {
	// Up to six per point, one per 60 degree slice of the tangent plane, the first centred on the closest.
	NeighborLists           neighbors;
	std::vector<double>     spacing;     // h_i: mean 3-D distance to them (unit-frame length)
	std::vector<int>        emptySlices; // largest number of *contiguous* empty slices, 0..6
	std::vector<PointStatus> status;     // Ok, Boundary (>= 2 contiguous), Isolated (>= 4), TooFewNeighbors
	double                  medianSpacing = 0.0;
};

MinimumNeighborhoods minimumNeighborhoods(
	const PointCloud&                 cloud,
	const NeighborSearch&             search,
	const MinimumNeighborhoodOptions& options  = {},
	const Progress&                   progress = {});

// Right-handed orthonormal tangent frame (u, v, n) at a unit normal; a pure function of n, continuous
// except at one pole, so that the same normal always gives the same frame.
struct TangentFrame {
	Eigen::Vector3d u, v, n;
	explicit TangentFrame(const Eigen::Vector3d& normal);
	Eigen::Vector2d toPlane(const Eigen::Vector3d& d) const { return {d.dot(u), d.dot(v)}; }
	Eigen::Vector3d toSpace(const Eigen::Vector2d& d) const { return d.x() * u + d.y() * v; }
};

} // namespace curvature_lines
