// Neighbour search and minimum neighbourhoods (A09 section 3, fig. 4a; R07 fig. 6a).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighborhoods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <nanoflann.hpp>

#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using DistanceIndex = std::pair<double, Index>;

struct PositionsAdaptor {
	const Eigen::Matrix3Xd& positions;

	std::size_t kdtree_get_point_count() const { return positions.cols(); }
	double kdtree_get_pt(std::size_t i, std::size_t c) const { return positions(c, i); }
	template<class Box>
	bool kdtree_get_bbox(Box&) const
	{
		return false;
	}
};

// The tree accumulates its lower bounds in floating point and compares strictly; the margin keeps points
// that tie with the limit, so that the exact (distance, index) order below decides and not the tree's.
constexpr double tieMargin = 1.0 + 1e-12;

struct ByDistanceThenIndex {
	bool operator()(const DistanceIndex& a, const DistanceIndex& b) const
	{
		return a.first < b.first || (a.first == b.first && a.second < b.second);
	}
};

// In order at any time: for the tens of neighbours that are asked for, sorting in beats a heap.
class NearestSet {
public:
	using DistanceType = double;
	NearestSet(
		std::vector<DistanceIndex>& found, std::size_t capacity, const std::vector<Index>* names) :
			m_found(found), m_capacity(capacity), m_names(names)
	{
		m_found.clear();
	}
	std::size_t size() const { return m_found.size(); }
	bool full() const { return m_found.size() == m_capacity; }
	void sort() {}
	double worstDist() const
	{
		return full() ? m_found.back().first * tieMargin + std::numeric_limits<double>::min()
		              : std::numeric_limits<double>::max();
	}
	bool addPoint(double distance, Index index)
	{
		const ByDistanceThenIndex less;
		const DistanceIndex       candidate(distance, m_names ? (*m_names)[index] : index);
		if (!full())
			m_found.push_back(candidate);
		else if (!less(candidate, m_found.back()))
			return true;
		DistanceIndex* const found = m_found.data();
		std::size_t          place = m_found.size() - 1;
		for (; place > 0 && less(candidate, found[place - 1]); --place)
			found[place] = found[place - 1];
		found[place] = candidate;
		return true;
	}

private:
	std::vector<DistanceIndex>& m_found;
	std::size_t                 m_capacity;
	const std::vector<Index>*   m_names;
};

class BallSet {
public:
	using DistanceType = double;
	BallSet(std::vector<DistanceIndex>& found, double squaredRadius) :
			m_found(found), m_squaredRadius(squaredRadius)
	{
		m_found.clear();
	}
	std::size_t size() const { return m_found.size(); }
	bool full() const { return true; }
	void sort() {}
	double worstDist() const
	{
		return m_squaredRadius * tieMargin + std::numeric_limits<double>::min();
	}
	bool addPoint(double distance, Index index)
	{
		if (distance <= m_squaredRadius)
			m_found.emplace_back(distance, index);
		return true;
	}

private:
	std::vector<DistanceIndex>& m_found;
	double                      m_squaredRadius;
};

class UnsortedBallSet {
public:
	using DistanceType = double;
	UnsortedBallSet(std::vector<Index>& found, double squaredRadius) :
			m_found(found), m_squaredRadius(squaredRadius)
	{
		m_found.clear();
	}
	std::size_t size() const { return m_found.size(); }
	bool full() const { return true; }
	void sort() {}
	double worstDist() const { return m_squaredRadius; }
	bool addPoint(double, Index index)
	{
		m_found.push_back(index);
		return true;
	}

private:
	std::vector<Index>& m_found;
	double              m_squaredRadius;
};

// Ends the search at the first point it meets.
class FirstInBall {
public:
	using DistanceType = double;
	explicit FirstInBall(double squaredRadius) : m_squaredRadius(squaredRadius) {}
	std::size_t size() const { return m_found ? 1 : 0; }
	bool full() const { return true; }
	void sort() {}
	double worstDist() const { return m_squaredRadius; }
	bool addPoint(double, Index)
	{
		m_found = true;
		return false;
	}

private:
	bool   m_found = false;
	double m_squaredRadius;
};

std::vector<Index> indicesOf(const std::vector<DistanceIndex>& found)
{
	std::vector<Index> indices(found.size());
	std::transform(
		found.begin(), found.end(), indices.begin(), [](const auto& f) { return f.second; });
	return indices;
}

constexpr int sliceCount = 6; // see sliceOf()

// Share of the neighbours on the side of a point's normal below which the normal is taken to be wrong. Of random
// normals half are; a point at the edge of a thin sheet still has about half of its neighbours on its own.
constexpr double minAgreement = 0.25;

// Points on the other sheet of a thin part have opposing normals. But a point that nearly all others
// oppose has a wrong normal itself, and would stand alone by that rule.
std::vector<Index>
sameSheet(const PointCloud& cloud, Index i, const Index* first, const Index* last)
{
	std::vector<Index> same;
	for (const Index* j = first; j != last; ++j)
		if (cloud.normals.col(i).dot(cloud.normals.col(*j)) > 0.0)
			same.push_back(*j);
	if (double(same.size()) < minAgreement * double(last - first))
		same.assign(first, last);
	return same;
}

// Slice 0 is centred on the direction `axis`.
int sliceOf(const Eigen::Vector2d& d, const Eigen::Vector2d& axis)
{
	// Turned by half a slice, where it is is told by the sides of three lines: cheaper than its angle.
	static const double   root3 = std::sqrt(3.0);
	const double          along = axis.dot(d), across = axis.x() * d.y() - axis.y() * d.x();
	const Eigen::Vector2d turned = {root3 * along - across, along + root3 * across};
	const bool            upper  = turned.y() > 0.0 || (turned.y() == 0.0 && turned.x() >= 0.0);
	const double          x = root3 * (upper ? turned.x() : -turned.x()), y = std::abs(turned.y());
	const int             inHalf = x > y || y == 0.0 ? 0 : -x < y ? 1 : 2;
	return upper ? inHalf : inHalf + sliceCount / 2;
}

// The projected-closest candidate of each slice, -1 where there is none within `reach` (3-D). The papers
// leave the phase of the slices open: the closest candidate of all sets it, so that neighbourhoods do not
// depend on the orientation of the axes or the sign of the normals.
std::array<Index, sliceCount> closestPerSlice(
	const PointCloud& cloud, Index i, const std::vector<Index>& candidates, double reach)
{
	const TangentFrame frame(cloud.normals.col(i));
	const auto         offset = [&](Index j) -> Eigen::Vector3d {
        return cloud.positions.col(j) - cloud.positions.col(i);
	};
	Eigen::Vector2d axis    = Eigen::Vector2d::UnitX();
	double          nearest = std::numeric_limits<double>::infinity();
	for (const Index j : candidates) {
		const Eigen::Vector2d projected = frame.toPlane(offset(j));
		const double          distance  = projected.squaredNorm();
		if (distance > 0.0 && distance < nearest) {
			nearest = distance;
			axis    = projected;
		}
	}

	std::array<Index, sliceCount>  slots;
	std::array<double, sliceCount> closest;
	slots.fill(-1);
	closest.fill(std::numeric_limits<double>::infinity());
	for (const Index j : candidates) {
		const Eigen::Vector3d d = offset(j);
		if (d.norm() > reach)
			continue;
		const Eigen::Vector2d projected = frame.toPlane(d);
		const double          distance  = projected.squaredNorm();
		const int             slice     = sliceOf(projected, axis);
		if (distance < closest[slice]) { // candidates come by (distance, index): ties are settled
			closest[slice] = distance;
			slots[slice]   = j;
		}
	}
	return slots;
}

double meanDistance(const PointCloud& cloud, Index i, const std::array<Index, sliceCount>& slots)
{
	double sum   = 0.0;
	int    count = 0;
	for (const Index j : slots) {
		if (j < 0)
			continue;
		sum += (cloud.positions.col(j) - cloud.positions.col(i)).norm();
		++count;
	}
	return count > 0 ? sum / count : 0.0;
}

int longestEmptyRun(const std::array<Index, sliceCount>& slots)
{
	int longest = 0, run = 0;
	for (int s = 0; s < 2 * sliceCount; ++s) { // twice around: the slices are cyclic
		run     = slots[s % sliceCount] < 0 ? run + 1 : 0;
		longest = std::max(longest, run);
	}
	return std::min(longest, sliceCount);
}

double positiveMedian(const std::vector<double>& values)
{
	std::vector<double> positive;
	for (const double v : values)
		if (v > 0.0)
			positive.push_back(v);
	return positive.empty() ? 0.0 : medianInPlace(positive);
}

} // namespace

struct NeighborSearch::Tree {
	using Metric = nanoflann::L2_Simple_Adaptor<double, PositionsAdaptor, double, Index>;
	using Index3 = nanoflann::KDTreeSingleIndexAdaptor<Metric, PositionsAdaptor, 3, Index>;

	explicit Tree(const Eigen::Matrix3Xd& positions) :
			adaptor{positions}, index(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(16))
	{
		index.buildIndex();
	}
	PositionsAdaptor adaptor;
	Index3           index;
};

NeighborSearch::NeighborSearch(const Eigen::Matrix3Xd& positions) :
		m_tree(std::make_shared<const Tree>(positions))
{
}

NeighborSearch::NeighborSearch(const NeighborSearch& other, const std::vector<Index>& names) :
		m_tree(other.m_tree), m_names(&names)
{
}

std::vector<Index> NeighborSearch::nearest(const Eigen::Vector3d& query, Index k) const
{
	if (k <= 0 || m_tree->adaptor.positions.cols() == 0)
		return {};
	thread_local std::vector<DistanceIndex> found;
	NearestSet                              set(found, k, m_names);
	m_tree->index.radiusSearchCustomCallback(query.data(), set);
	return indicesOf(found);
}

std::vector<Index> NeighborSearch::within(const Eigen::Vector3d& query, double radius) const
{
	if (!(radius >= 0.0) || m_tree->adaptor.positions.cols() == 0)
		return {};
	thread_local std::vector<DistanceIndex> found;
	BallSet                                 set(found, radius * radius);
	m_tree->index.radiusSearchCustomCallback(query.data(), set);
	for (DistanceIndex& f : found)
		f.second = nameOf(f.second);
	std::sort(found.begin(), found.end(), ByDistanceThenIndex());
	return indicesOf(found);
}

void NeighborSearch::within(
	const Eigen::Vector3d& query, double radius, std::vector<Index>& found) const
{
	found.clear();
	if (!(radius >= 0.0) || m_tree->adaptor.positions.cols() == 0)
		return;
	UnsortedBallSet set(found, radius * radius);
	m_tree->index.radiusSearchCustomCallback(query.data(), set);
	if (m_names)
		for (Index& f : found)
			f = (*m_names)[f];
}

bool NeighborSearch::anyWithin(const Eigen::Vector3d& query, double radius) const
{
	if (!(radius >= 0.0) || m_tree->adaptor.positions.cols() == 0)
		return false;
	FirstInBall first(radius * radius);
	m_tree->index.radiusSearchCustomCallback(query.data(), first);
	return first.size() > 0;
}

std::vector<Index> NeighborSearch::spatialOrder() const
{
	std::vector<Index> order = m_tree->index.vAcc; // leaf by leaf
	for (Index& i : order)
		i = nameOf(i);
	return order;
}

void parallelForPoints(
	const NeighborSearch& search, const Progress& progress, const std::function<void(Index)>& body)
{
	const std::vector<Index> order = search.spatialOrder();
	parallelFor(static_cast<Index>(order.size()), progress, [&](Index k) { body(order[k]); });
}

MinimumNeighborhoods minimumNeighborhoods(
	const PointCloud&                 cloud,
	const NeighborSearch&             search,
	const MinimumNeighborhoodOptions& options,
	const Progress&                   progress)
{
	const Index n       = cloud.size();
	const Index rowSize = std::max<Index>(0, std::min<Index>(options.candidates, n - 1));
	std::vector<Index> candidates(std::size_t(n) * rowSize);
	std::vector<double> freeSpacing(n); // without a threshold on the distance
	const auto rowOf = [&](Index i) { return candidates.data() + std::size_t(i) * rowSize; };

	parallelForPoints(search, progress.sub(0.0, 0.7, "Finding neighbors"), [&](Index i) {
		Index* row = rowOf(i);
		Index* end = row;
		for (const Index j : search.nearest(cloud.positions.col(i), rowSize + 1))
			if (j != i && end != row + rowSize)
				*end++ = j;
		const auto slots = closestPerSlice(
			cloud, i, sameSheet(cloud, i, row, end), std::numeric_limits<double>::infinity());
		freeSpacing[i] = meanDistance(cloud, i, slots);
	});

	MinimumNeighborhoods            result;
	const double                    median = positiveMedian(freeSpacing);
	std::vector<std::vector<Index>> rows(n);
	result.spacing.resize(n);
	result.emptySlices.resize(n);
	result.status.resize(n);
	parallelForPoints(search, progress.sub(0.7, 1.0, "Finding neighborhoods"), [&](Index i) {
		const Index*                     row = rowOf(i);
		thread_local std::vector<double> local;
		local.clear();
		for (Index c = 0; c < rowSize; ++c)
			local.push_back(freeSpacing[row[c]]);
		const double scale = local.empty() ? median : std::max(median, medianInPlace(local));
		const auto   slots = closestPerSlice(
            cloud, i, sameSheet(cloud, i, row, row + rowSize), options.boundaryThreshold * scale);
		for (const Index j : slots)
			if (j >= 0)
				rows[i].push_back(j);
		const double spacing  = meanDistance(cloud, i, slots);
		const int    run      = longestEmptyRun(slots);
		result.spacing[i]     = spacing > 0.0 ? spacing : (scale > 0.0 ? scale : 1.0);
		result.emptySlices[i] = run;
		result.status[i]      = run >= 4             ? PointStatus::Isolated
		                        : rows[i].size() < 3 ? PointStatus::TooFewNeighbors
		                        : run >= 2           ? PointStatus::Boundary
		                                             : PointStatus::Ok;
	});
	result.neighbors     = NeighborLists::fromRows(rows);
	result.medianSpacing = positiveMedian(result.spacing);
	return result;
}

TangentFrame::TangentFrame(const Eigen::Vector3d& normal) : n(normal)
{
	// Rotates e_z onto n about their common normal (Frisvad 2012); the pole is -e_z. Near it 1 + n.z
	// cancels, (n.x^2 + n.y^2) / (1 - n.z) is the same number without the loss.
	const double inPlane = n.x() * n.x() + n.y() * n.y();
	const double onePlus = n.z() > 0.0 ? 1.0 + n.z() : inPlane / (1.0 - n.z());
	if (onePlus < std::numeric_limits<double>::min()) {
		u = Eigen::Vector3d::UnitX();
		v = -Eigen::Vector3d::UnitY();
		return;
	}
	const double a = 1.0 / onePlus;
	u              = {1.0 - n.x() * n.x() * a, -n.x() * n.y() * a, -n.x()};
	v              = {-n.x() * n.y() * a, 1.0 - n.y() * n.y() * a, -n.y()};
}

Eigen::Vector3d tangentNear(const Eigen::Vector3d& d, const Eigen::Vector3d& n)
{
	const Eigen::Vector3d tangent = d - n * n.dot(d);
	const double          length  = tangent.norm();
	return length > 1e-6 ? Eigen::Vector3d(tangent / length) : TangentFrame(n).u;
}

} // namespace curvature_lines
