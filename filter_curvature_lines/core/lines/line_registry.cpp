// Flow segments registered per Voronoi cell and the proximity queries over them (A09 section 5.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_registry.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

// Cosine of the angle of normals, 60 degrees: beyond, a segment is on another sheet or behind a fold, and
// the two sides of a thin plate do not stop each other's lines. The papers have no such test.
constexpr double sameSheet = 0.5;

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

double distance2ToSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b)
{
	const Vector3d ab      = b - a;
	const double   length2 = ab.squaredNorm();
	const double   t       = length2 > 0.0 ? std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
	return (a + t * ab - x).squaredNorm();
}

double area(const Vector2d& a, const Vector2d& b, const Vector2d& c)
{
	return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Half-open at both ends, so that a crossing at a shared vertex of two pieces counts once.
bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d)
{
	return (area(a, b, c) > 0.0) != (area(a, b, d) > 0.0) &&
	       (area(c, d, a) > 0.0) != (area(c, d, b) > 0.0);
}

} // namespace

NeighborLists proximityGraph(const MinimumNeighborhoods& minimum)
{
	const NeighborLists&            lists = minimum.neighbors;
	std::vector<std::vector<Index>> rows(lists.size());
	for (Index i = 0; i < lists.size(); ++i)
		for (Index j : lists[i]) {
			rows[i].push_back(j);
			rows[j].push_back(i);
		}
	for (std::vector<Index>& row : rows) {
		std::sort(row.begin(), row.end());
		row.erase(std::unique(row.begin(), row.end()), row.end());
	}
	return NeighborLists::fromRows(rows);
}

LineRegistry::LineRegistry(
	const PointCloud& cloud, const MinimumNeighborhoods& minimum, const NeighborLists& proximity) :
		m_positions(cloud.positions), m_spacing(minimum.spacing), m_neighbors(proximity),
		m_first(cloud.size(), -1), m_visited(cloud.size(), 0)
{
}

void LineRegistry::enter(Index cell, Index segment)
{
	m_entries.push_back({segment, m_first[cell]});
	m_first[cell] = static_cast<Index>(m_entries.size()) - 1;
}

void LineRegistry::add(const FlowSegment& segment)
{
	const Index id = size();
	m_segments.push_back(segment);
	enter(segment.fromCell, id);
	if (segment.toCell != segment.fromCell)
		enter(segment.toCell, id);
}

void LineRegistry::truncate(Index size)
{
	const auto leave = [&](Index cell) {
		m_first[cell] = m_entries.back().next;
		m_entries.pop_back();
	};
	while (this->size() > size) {
		const FlowSegment& last = m_segments.back();
		if (last.toCell != last.fromCell)
			leave(last.toCell);
		leave(last.fromCell);
		m_segments.pop_back();
	}
}

bool LineRegistry::blocks(const FlowSegment& segment, const ProximityQuery& query) const
{
	const bool own = segment.line == query.line;
	if (own && (segment.arc <= query.ownFrom || segment.arc >= query.ownTo))
		return false;
	const double radius = own ? query.ownRadius : query.radius;
	return segment.normal.dot(query.normal) > sameSheet &&
	       distance2ToSegment(query.position, segment.from, segment.to) < radius * radius;
}

bool LineRegistry::occupied(const ProximityQuery& query)
{
	if (++m_query == 0) { // the stamps have run round
		std::fill(m_visited.begin(), m_visited.end(), 0u);
		m_query = 1;
	}
	m_queue.assign(1, query.cell);
	m_visited[query.cell] = m_query;
	for (std::size_t k = 0; k < m_queue.size(); ++k) {
		for (Index e = m_first[m_queue[k]]; e >= 0; e = m_entries[e].next)
			if (blocks(m_segments[m_entries[e].segment], query))
				return true;
		for (Index j : m_neighbors[m_queue[k]]) {
			if (m_visited[j] == m_query)
				continue;
			m_visited[j] = m_query;
			// A point of a segment is about a spacing at most from the site it is registered with.
			const double reach = query.radius + m_spacing[j];
			if ((m_positions.col(j) - query.position).squaredNorm() <= reach * reach)
				m_queue.push_back(j);
		}
	}
	return false;
}

Index LineRegistry::countCrossings(const LineRegistry& other, const Matrix3Xd& normals) const
{
	Index count = 0;
	for (Index cell = 0; cell < static_cast<Index>(m_first.size()); ++cell) {
		if (m_first[cell] < 0 || other.m_first[cell] < 0)
			continue;
		const TangentFrame frame(normals.col(cell));
		const auto         flat = [&](const Vector3d& x) {
            return frame.toPlane(x - m_positions.col(cell));
		};
		for (Index e = m_first[cell]; e >= 0; e = m_entries[e].next) {
			const FlowSegment& s = m_segments[m_entries[e].segment];
			const Vector2d     a = flat(s.from), b = flat(s.to);
			for (Index f = other.m_first[cell]; f >= 0; f = other.m_entries[f].next) {
				const FlowSegment& t = other.m_segments[other.m_entries[f].segment];
				// Two segments that share two cells are looked at in the first only.
				if (cell != s.fromCell && (t.fromCell == s.fromCell || t.toCell == s.fromCell))
					continue;
				if (cross(a, b, flat(t.from), flat(t.to)))
					++count;
			}
		}
	}
	return count;
}

} // namespace curvature_lines
