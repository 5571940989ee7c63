// Nearest neighbours and the six-slice minimum neighbourhood with its boundary flag
// (A09 section 3 and fig. 4a; R07 fig. 6a).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "members.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// A kd-tree over fixed positions (nanoflann behind it). The positions must outlive the tree. Copies share it.
class NeighborSearch {
public:
	explicit NeighborSearch(const Eigen::Matrix3Xd& positions);
	// The same tree with other names: what `other` calls i is names[i] here, a permutation that must outlive this.
	NeighborSearch(const NeighborSearch& other, const std::vector<Index>& names);

	// Indices of the k nearest points, by increasing distance, ties by index. Fewer if the cloud is smaller.
	std::vector<Index> nearest(const Eigen::Vector3d& query, Index k) const;
	// All points within radius, by increasing distance, ties by index.
	std::vector<Index> within(const Eigen::Vector3d& query, double radius) const;
	// The same without sorting, into storage the caller keeps: for large balls. The order is fixed.
	void within(const Eigen::Vector3d& query, double radius, std::vector<Index>& found) const;
	bool anyWithin(const Eigen::Vector3d& query, double radius) const;
	// All indices, those of points near each other mostly in turn: loops that take them so find in the cache
	// what the step before has read.
	std::vector<Index> spatialOrder() const;

private:
	struct Tree;
	Index nameOf(Index i) const { return m_names ? (*m_names)[i] : i; }

	std::shared_ptr<const Tree> m_tree;
	const std::vector<Index>*   m_names = nullptr; // none: as the tree was built
};

// parallelFor over the points searched in, those near each other in turn.
void parallelForPoints(
	const NeighborSearch& search, const Progress& progress, const std::function<void(Index)>& body);

struct MinimumNeighborhoodOptions {
	// A slice is empty when no point in it is nearer than this many median spacings; the median is that of
	// the cloud or of the candidates, whichever is larger: a sparse part of a scan is not a boundary.
	double boundaryThreshold = 2.5;
	// Candidates looked at per point; those whose normal opposes the point's are on another sheet, unless
	// nearly all do, because then it is the point's normal that is wrong.
	Index candidates = 40;
};

inline bool operator==(const MinimumNeighborhoodOptions& a, const MinimumNeighborhoodOptions& b)
{
	return members<2>(a) == members<2>(b);
}

struct MinimumNeighborhoods {
	// Up to six per point, one per 60 degree slice of the tangent plane, the first centred on the closest.
	NeighborLists       neighbors;
	std::vector<double> spacing;     // h_i: mean 3-D distance to them (unit-frame length)
	std::vector<int>    emptySlices; // largest number of *contiguous* empty slices, 0..6
	// Ok, Boundary (>= 2 contiguous), Isolated (>= 4), TooFewNeighbors
	std::vector<PointStatus> status;
	double                   medianSpacing = 0.0;
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

// The unit tangent at a unit normal n that is nearest to d; TangentFrame(n).u where d has no tangent part (shorter than
// 1e-6).
Eigen::Vector3d tangentNear(const Eigen::Vector3d& d, const Eigen::Vector3d& n);

} // namespace curvature_lines
